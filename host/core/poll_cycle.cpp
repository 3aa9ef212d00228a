// SPDX-License-Identifier: Apache-2.0
#include "host/core/poll_cycle.hpp"

#include <utility>

namespace coupler::driver {

PollCycle::PollCycle(const Map& map, std::vector<ReadSpan> plan, Duration period)
    : map_(map), plan_(std::move(plan)), schedule_(period) {}

void PollCycle::start(Time now) {
  steps_.clear();
  for (const ReadSpan& span : plan_) steps_.push_back({span, std::nullopt});
  next_ = 0;
  schedule_.start(now);
}

bool PollCycle::answered(std::optional<modbus::Exception> exception, Time now) {
  const bool news = std::exchange(steps_[next_].last, exception) != exception;
  ++next_;
  advance_if_done(now);
  return news;
}

std::optional<std::uint32_t> PollCycle::rejected(Time now) {
  const ReadSpan span = current();
  const std::vector<ReadSpan> pieces = split(span, map_);
  auto at = steps_.erase(steps_.begin() + static_cast<std::ptrdiff_t>(next_));
  for (const ReadSpan& piece : pieces) at = std::next(steps_.insert(at, {piece, std::nullopt}));
  advance_if_done(now);
  if (!pieces.empty()) return std::nullopt;
  return span.points.front();
}

void PollCycle::give_up(Time now) {
  steps_.erase(steps_.begin() + static_cast<std::ptrdiff_t>(next_));
  advance_if_done(now);
}

void PollCycle::advance_if_done(Time now) {
  if (next_ < steps_.size()) return;
  next_ = 0;
  schedule_.advance(now);
}

}  // namespace coupler::driver
