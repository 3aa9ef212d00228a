// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/client/scheduling.hpp"

#include <iterator>

namespace coupler::client {

const host::ScheduleAnswer& PendingSchedule::answer() {
  if (!answer_) answer_ = asked_.get();
  return *answer_;
}

std::optional<ScheduleResult> PendingSchedule::wait(std::chrono::milliseconds at_most) {
  if (!accepted()) return std::nullopt;
  std::unique_lock lock(state_->mutex);
  state_->came.wait_for(lock, at_most, [this] { return state_->result.has_value(); });
  return state_->result;
}

ScheduleResults::Key ScheduleResults::add(const std::shared_ptr<PendingSchedule::State>& state) {
  const std::lock_guard lock(mutex_);
  for (auto each = expected_.begin(); each != expected_.end();)
    each = each->second.expired() ? expected_.erase(each) : std::next(each);
  expected_.emplace(++last_, state);
  return last_;
}

void ScheduleResults::tell(const host::ScheduledOutcome& outcome) {
  std::shared_ptr<PendingSchedule::State> state;
  {
    const std::lock_guard lock(mutex_);
    if (const auto expected = expected_.extract(outcome.asked)) state = expected.mapped().lock();
  }
  if (!state) return;
  const std::lock_guard lock(state->mutex);
  state->result = {outcome.result, outcome.reason, outcome.at, outcome.lateness()};
  state->came.notify_all();
}

}  // namespace coupler::client
