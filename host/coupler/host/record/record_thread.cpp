// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/record/record_thread.hpp"

#include <algorithm>
#include <chrono>
#include <exception>
#include <utility>

#include <fmt/format.h>

namespace coupler::host {
namespace {

/// How much a process that is killed loses at most.
constexpr std::chrono::milliseconds write_period{250};
/// Between attempts to go on, each of which takes its time if there are many points.
constexpr std::chrono::milliseconds longest_pause{5000};

}  // namespace

RecordThread::RecordThread(Recorder& recorder, RecordFile file, Recorder::Report report)
    : recorder_(recorder), file_(std::move(file)), report_(std::move(report)), path_(file_.path()) {
  thread_ = std::thread([this] { run(); });
}

bool RecordThread::end() {
  if (!thread_.joinable()) return is_whole_;
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
  }
  ends_now_.notify_all();
  thread_.join();
  return is_whole_;
}

/// Whatever happens to the files is no reason for a driver to end.
void RecordThread::run() {
  try {
    write_on();
  } catch (const std::exception& error) {
    is_whole_ = false;
    report_(Level::error, fmt::format("{}; nothing more is recorded", error.what()));
  }
}

void RecordThread::write_on() {
  const auto now = [] { return std::chrono::steady_clock::now(); };
  take(file_.begin(recorder_.turn(now()).beginning), now());
  std::unique_lock lock(mutex_);
  while (!ends_) {
    ends_now_.wait_for(lock, write_period);
    lock.unlock();
    if (!missing_since_ || now() >= retry_at_) write(now());
    lock.lock();
  }
  write(now());
  is_whole_ = !missing_since_ && take(file_.write(recorder_.end(now())), now());
}

void RecordThread::write(Time now) {
  const Recorder::Taken taken = recorder_.take(now);
  if (taken.lost && !missing_since_) miss("the disk was too slow");
  if (!missing_since_ && (!take(file_.write(taken.lines), now) || !file_.is_full())) return;
  const Recorder::Turn turn = recorder_.turn(std::chrono::steady_clock::now());
  if (missing_since_) {
    const std::string missing = recorder_.missing(now, *missing_since_, why_missing_);
    retry_at_ = now + retry_pause_;
    retry_pause_ = std::min(2 * retry_pause_, longest_pause);
    if (!take(file_.begin(turn.beginning + missing), now)) return;
    retry_pause_ = write_period;
    missing_since_.reset();
    report_(Level::info, "recording again");
    return;
  }
  if (take(file_.write(turn.before.lines), now)) take(file_.begin(turn.beginning), now);
}

bool RecordThread::take(const tl::expected<void, std::string>& outcome, Time now) {
  written_ = file_.written();
  if (outcome)
    last_written_ = now;
  else if (!missing_since_)
    miss(outcome.error());
  return outcome.has_value();
}

void RecordThread::miss(const std::string& why) {
  missing_since_ = last_written_;
  why_missing_ = why;
  report_(Level::error, why + "; nothing is recorded until that is fixed");
}

}  // namespace coupler::host
