// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "coupler/host/core/stamp.hpp"
#include "coupler/host/motion/condition.hpp"
#include "coupler/map/map.hpp"

namespace coupler::host {

struct WaitGoal {
  std::uint32_t point = 0;  ///< an index into Map::points
  Condition condition;
  Duration for_at_least{};  ///< the condition must have held so long; 0: it must have come true
  Time since{};             ///< what happened since then counts
  Time deadline{};
};

/// Decides from the values of one point, which it is shown in their order, when a condition is met. All
/// registers are host_registers() of the point.
class Wait {
 public:
  Wait(const WaitGoal& goal, const Point& point) : goal_(goal), point_(&point) {}

  /// The value from which the next one may differ.
  void begin_with(const std::uint16_t* registers) { last_ = copy(registers); }
  /// The device gave this value at the time of the stamp. Values come in their order.
  void see(const Stamp& stamp, const std::uint16_t* registers);
  /// Nothing is known of the value from the last one to the next.
  void interrupt() {
    if (met_) return;
    since_.reset();
    last_.clear();
  }

  const WaitGoal& goal() const { return goal_; }
  bool is_met() const { return met_; }
  /// Returns whether it has seen a value that counts.
  bool has_seen() const { return has_seen_; }
  /// The stamp of the value or of the change that met the condition, or that may meet it when it has held
  /// long enough.
  const std::optional<Stamp>& since() const { return since_; }
  /// The time at which the condition is met if it goes on to hold; Time::max() if it does not hold.
  Time due() const { return since_ ? since_->at + goal_.for_at_least : Time::max(); }
  /// The value that was seen last; empty: none.
  const std::vector<std::uint16_t>& last() const { return last_; }

 private:
  std::vector<std::uint16_t> copy(const std::uint16_t* registers) const;
  bool counts(const Stamp& stamp) const;

  WaitGoal goal_;
  const Point* point_;
  std::vector<std::uint16_t> last_;
  std::optional<Stamp> since_;
  bool has_seen_ = false;
  bool met_ = false;
};

}  // namespace coupler::host
