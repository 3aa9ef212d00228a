// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/motion/wait.hpp"

#include <utility>

#include "coupler/map/published.hpp"

namespace coupler::host {

std::vector<std::uint16_t> Wait::copy(const std::uint16_t* registers) const {
  return {registers, registers + host_registers(*point_)};
}

/// A value must have been read after the time from which it counts. A change may have been after that time,
/// so it is not missed. What comes behind something that counts does so, too.
bool Wait::counts(const Stamp& stamp) const {
  const Time at = goal_.condition.is_event() ? stamp.at + stamp.uncertainty : stamp.at - stamp.uncertainty;
  return has_seen_ || at >= goal_.since;
}

void Wait::see(const Stamp& stamp, const std::uint16_t* registers) {
  if (met_) return;
  const std::vector<std::uint16_t> before = std::exchange(last_, copy(registers));
  if (!counts(stamp)) return;
  has_seen_ = true;
  const Condition& condition = goal_.condition;
  const bool holds = condition.holds(registers);
  if (condition.is_event()) {
    if (!before.empty() && before != last_ && condition.happens(before.data(), registers)) since_ = stamp;
  } else if (!since_ && holds) {
    since_ = stamp;
  }
  if (!holds) since_.reset();
  met_ = since_ && stamp.at - since_->at >= goal_.for_at_least;
}

}  // namespace coupler::host
