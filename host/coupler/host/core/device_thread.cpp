// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/core/device_thread.hpp"

#include <exception>
#include <utility>

#include "coupler/base/what_failed.hpp"

namespace coupler::host {
namespace {

using std::chrono::milliseconds;

/// The time limit for safe values at the end: the program has to be gone within a second.
constexpr milliseconds longest_shutdown(700);
/// The time limit for the first of these requests if the device does not reply.
constexpr milliseconds longest_attempt(100);
/// The time until a connection that could not be given up is given up again.
constexpr milliseconds retry(100);

}  // namespace

DeviceThread::DeviceThread(const Map& map, Purpose purpose, MapLoader load, Link& link, ValueTable& values,
                           Sink& sink)
    : link_(link),
      device_(map, purpose, std::move(load), link, values, sink),
      ends_safely_(map.on_shutdown == OnShutdown::safe) {}

void DeviceThread::start() {
  const std::lock_guard life(life_);
  if (!stopping_) thread_ = std::thread([this] { run(); });
}

bool DeviceThread::end() {
  const std::lock_guard life(life_);
  stopping_ = true;
  if (!thread_.joinable()) return ended_safely_;
  link_.wake();
  if (ends_safely_ || device_.has_to_end()) await_stop();
  device_.end_comes();
  link_.interrupt();
  thread_.join();
  return ended_safely_;
}

/// A device that does not answer has a moment only: it may hold a connection that other units need for their
/// safe values.
void DeviceThread::await_stop() {
  const auto stopped = stopped_.get_future();
  if (stopped.wait_for(longest_attempt) == std::future_status::ready) return;
  if (is_ending_ || device_.answers()) stopped.wait_for(longest_shutdown - longest_attempt);
}

void DeviceThread::write(const Write& write) {
  device_.push(write);
  send_queued();
}

void DeviceThread::write_together(Span<const Write> writes) {
  device_.push_together(writes);
  send_queued();
}

void DeviceThread::send_queued() {
  if (is_over_) return device_.drop_all();
  if (owner_ == std::this_thread::get_id()) return;  // the step that is being made sees it at its end
  const std::unique_lock turn(turn_, std::try_to_lock);
  if (!turn || !send_now()) link_.wake();
}

/// Keeps an exception for the owner, because only the owner may close the connection.
bool DeviceThread::send_now() {
  try {
    return device_.send_now();
  } catch (...) {
    thrown_ = std::current_exception();
    return false;
  }
}

void DeviceThread::want(std::uint32_t point, bool wanted) {
  demand_.set(point, wanted);
  link_.wake();
}

std::future<CallAnswer> DeviceThread::make_safe() {
  auto answer = device_.make_safe();
  link_.wake();
  return answer;
}

std::future<CallAnswer> DeviceThread::reset_watchdog() {
  auto answer = device_.reset_watchdog();
  link_.wake();
  return answer;
}

std::future<ScheduleAnswer> DeviceThread::schedule(const ScheduledWrite& what) {
  auto answer = device_.schedule(what);
  link_.wake();
  return answer;
}

void DeviceThread::schedule(const ScheduledWrite& what, Reply<ScheduleAnswer>::Give give) {
  device_.schedule(what, std::move(give));
  link_.wake();
}

std::future<CallAnswer> DeviceThread::cancel_scheduled(std::uint32_t number) {
  auto answer = device_.cancel_scheduled(number);
  link_.wake();
  return answer;
}

void DeviceThread::cancel_all(WritesFrom which, Reply<CallAnswer>::Give give) {
  device_.cancel_all(std::move(which), std::move(give));
  link_.wake();
}

/// An exception, for lack of memory for what the device sends, for example, costs this device its connection,
/// and no other.
template <class Work>
Time DeviceThread::attempt(Work work) {
  if (thrown_)
    if (const Time next = give_up(std::exchange(thrown_, nullptr)); thrown_ && !is_ending_) return next;
  try {
    return work();
  } catch (...) {
    return give_up(std::current_exception());
  }
}

Time DeviceThread::give_up(const std::exception_ptr& thrown) {
  try {
    return device_.give_up(what_failed(thrown));
  } catch (...) {   // no memory for a text
    link_.close();  // gives back the turn of the request that has thrown
    thrown_ = thrown;
    return link_.clock().now() + retry;
  }
}

Time DeviceThread::step() {
  const std::lock_guard turn(turn_);
  return attempt([this] {
    demand_.take([this](std::uint32_t point, bool wanted) { device_.want(point, wanted); });
    return device_.step();
  });
}

void DeviceThread::run() {
  owner_ = std::this_thread::get_id();
  while (!stopping_) {
    if (link_.wait_until(step()) != Woken::by_bytes) continue;
    {
      const std::lock_guard turn(turn_);
      attempt([this] {
        device_.arrived();
        return Time::min();
      });
    }
    // If there is only one processor, the thread that sends what the sink received gets it first: the message
    // leaves before the next request is sent.
    std::this_thread::yield();
  }
  is_ending_ = true;
  {
    const std::lock_guard turn(turn_);
    ended_safely_ = !ends_safely_;
    attempt([this] {
      ended_safely_ = device_.stop();
      return Time::max();
    });
    is_over_ = true;  // first: what comes now is dropped by the one who makes it, or here
    attempt([this] {
      device_.drop_all();
      return Time::max();
    });
  }
  stopped_.set_value();
}

}  // namespace coupler::host
