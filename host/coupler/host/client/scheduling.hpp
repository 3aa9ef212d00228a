// SPDX-License-Identifier: Apache-2.0
// Values that the points of a client are to have at a time.
#pragma once

#include <chrono>
#include <condition_variable>
#include <future>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "coupler/host/core/scheduled.hpp"

namespace coupler::client {

/// The outcome of a value that was scheduled.
struct ScheduleResult {
  using Outcome = host::ScheduledOutcome::Result;

  Outcome outcome = Outcome::done;
  std::string reason{};       ///< empty when done
  host::Stamp at{};           ///< when it was carried out; otherwise when that was known
  host::Duration lateness{};  ///< ScheduledOutcome::lateness()

  /// It was carried out.
  explicit operator bool() const { return outcome == Outcome::done; }
};

/// A value that was asked for. It may be ignored, and outlive the client. A callback of the client must not
/// wait for it.
class PendingSchedule {
 public:
  /// Returns whether the device, or the client's own timer, will carry it out. Waits for the answer, a few of
  /// the device's timeouts at most.
  bool accepted() { return answer().number != 0; }
  /// Returns who carries it out, or why nobody does and what to do about it. Waits as accepted() does.
  const std::string& text() { return answer().text; }
  /// Returns the outcome; nullopt if it is not known within `at_most`, or if the value was not accepted.
  std::optional<ScheduleResult> wait(std::chrono::milliseconds at_most);

 private:
  friend class ScheduleResults;
  struct State {
    std::mutex mutex;
    std::condition_variable came;
    std::optional<ScheduleResult> result;
  };

  const host::ScheduleAnswer& answer();

  std::future<host::ScheduleAnswer> asked_;
  std::optional<host::ScheduleAnswer> answer_;
  std::shared_ptr<State> state_;
};

/// Brings outcomes to those who wait for them. For any thread.
class ScheduleResults {
 public:
  /// Calls `ask(what)`, which gives a future of the answer. The outcome may come before that.
  template <class Ask>
  PendingSchedule expect(host::ScheduledWrite what, Ask ask) {
    PendingSchedule pending;
    pending.state_ = std::make_shared<PendingSchedule::State>();
    what.asked = add(pending.state_);
    pending.asked_ = ask(what);
    return pending;
  }
  void tell(const host::ScheduledOutcome& outcome);

 private:
  using Key = std::chrono::nanoseconds;  ///< ScheduledWrite::asked, which comes back

  Key add(const std::shared_ptr<PendingSchedule::State>& state);

  std::mutex mutex_;
  std::map<Key, std::weak_ptr<PendingSchedule::State>>
      expected_;  ///< those that nobody waits for any more, too
  Key last_{0};
};

}  // namespace coupler::client
