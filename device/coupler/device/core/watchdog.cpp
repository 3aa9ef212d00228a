// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/core/watchdog.hpp"

#include <algorithm>

namespace coupler::device {

void OutputWatchdog::arm(TimePoint now) {
  if (!is_present()) return;
  state_ = State::armed;
  deadline_ = now + settings_.timeout;
}

void OutputWatchdog::request(ClientSession& session, bool wrote_output, TimePoint now) {
  session.has_written |= wrote_output;
  const bool feeds = wrote_output || (session.has_written && settings_.fed_by == Watchdog::FedBy::any);
  if (feeds && state_ == State::armed) deadline_ = now + settings_.timeout;
}

void OutputWatchdog::reset() {
  if (state_ != State::expired) return;
  state_ = State::idle;
  deadline_.reset();
}

void OutputWatchdog::expire(bool outputs_are_safe, TimePoint now) {
  state_ = State::expired;
  deadline_.reset();
  if (!outputs_are_safe) deadline_ = now + settings_.timeout;
}

void OutputWatchdog::disarm() {
  if (state_ != State::armed) return;
  state_ = State::idle;
  deadline_.reset();
}

void OutputWatchdog::take_over(const OutputWatchdog& before, TimePoint now) {
  if (!is_present() || !before.is_present()) return;
  state_ = before.state_;
  if (before.deadline_) deadline_ = now + settings_.timeout;
}

std::chrono::milliseconds OutputWatchdog::left(TimePoint now) const {
  using std::chrono::milliseconds;
  if (state_ != State::armed) return milliseconds(0);
  return std::max(milliseconds(0), std::chrono::ceil<milliseconds>(*deadline_ - now));
}

}  // namespace coupler::device
