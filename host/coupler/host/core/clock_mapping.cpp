// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/core/clock_mapping.hpp"

#include <algorithm>
#include <utility>

namespace coupler::host {
namespace {

using modbus::NodeTime;
using Nanoseconds = std::chrono::duration<double, std::nano>;

/// A century. What is further away overflows, and no machine runs that long.
constexpr NodeTime longest_time = std::chrono::hours(24 * 365 * 100);

/// The shortest time after which a drift is worth measuring.
constexpr NodeTime measured_over = std::chrono::seconds(10);

/// By so much the times of a clock that counts milliseconds, as a microcontroller's may, contradict each
/// other: that is no jump.
constexpr Nanoseconds coarsest_tick = std::chrono::milliseconds(1);

bool is_possible(NodeTime at) { return at >= NodeTime::zero() && at <= longest_time; }

double between(NodeTime from, NodeTime to) { return Nanoseconds(to - from).count(); }

}  // namespace

double ClockMapping::least_at(NodeTime at) const {
  const double passed = between(least_.as_of, at);
  return least_.offset + passed * (passed >= 0 ? drift_.least : drift_.most);
}

double ClockMapping::most_at(NodeTime at) const {
  const double passed = between(most_.as_of, at);
  return most_.offset + passed * (passed >= 0 ? drift_.most : drift_.least);
}

void ClockMapping::forget() { *this = ClockMapping(); }

ClockMapping::Outcome ClockMapping::add(const Exchange& exchange) {
  const auto offset = [this](Time ours, NodeTime node) {
    return Nanoseconds((ours - base_) - (node - base_node_)).count();
  };
  if (!is_possible(exchange.arrived) || !is_possible(exchange.replied) ||
      exchange.replied < exchange.arrived || exchange.received < exchange.sent) {
    forget();
    return Outcome::refused;
  }
  const bool is_first = !known_;
  if (is_first) begin(exchange);
  const double least = offset(exchange.sent, exchange.arrived);
  const double most = offset(exchange.received, exchange.replied);
  // Before a bound gives way to a newer one, which may hide it.
  Nanoseconds contradiction(
      is_first ? 0 : std::max(least - most_at(exchange.arrived), least_at(exchange.replied) - most));
  if (is_first || least >= least_at(exchange.arrived)) least_ = {exchange.arrived, least};
  if (is_first || most <= most_at(exchange.replied)) most_ = {exchange.replied, most};
  if (is_first) reference_ = interval_at(exchange.replied);
  // Between the two bounds' own times they are as close as anywhere.
  const Interval closest = interval_at(least_.as_of);
  contradiction = std::max(contradiction, Nanoseconds(closest.least - closest.most));
  if (contradiction.count() > 0) {
    forget();
    if (is_first || add(exchange) == Outcome::refused) return Outcome::refused;
    return contradiction > coarsest_tick ? Outcome::jumped : Outcome::taken;
  }
  measure_drift(exchange.replied);
  return Outcome::taken;
}

void ClockMapping::begin(const Exchange& exchange) {
  known_ = true;
  base_ = exchange.sent;
  base_node_ = exchange.arrived;
}

void ClockMapping::measure_drift(NodeTime now) {
  const double passed = between(reference_.as_of, now);
  if (passed < Nanoseconds(measured_over).count()) return;
  const Interval then = std::exchange(reference_, interval_at(now));
  const auto possible = [](double drift) { return std::clamp(drift, -most_drift, most_drift); };
  const Drift drift{possible((reference_.least - then.most) / passed - most_wander),
                    possible((reference_.most - then.least) / passed + most_wander)};
  // Bounds from before were carried on at the speeds that were possible until now.
  least_ = {now, reference_.least};
  most_ = {now, reference_.most};
  drift_ = drift;
}

std::optional<Stamp> ClockMapping::map(NodeTime at) const {
  if (!known_ || !is_possible(at)) return std::nullopt;
  const Interval offset = interval_at(at);
  const Nanoseconds middle((offset.least + offset.most) / 2);
  const Nanoseconds half((offset.most - offset.least) / 2 + 1);  // of rounding
  return Stamp{base_ + (at - base_node_) + std::chrono::duration_cast<Duration>(middle),
               std::chrono::duration_cast<Duration>(half)};
}

std::optional<NodeTime> ClockMapping::node_time(Time at) const {
  if (!known_) return std::nullopt;
  const NodeTime passed = base_node_ + std::chrono::duration_cast<NodeTime>(at - base_);
  NodeTime node = passed;
  // The offset hardly depends on when it is asked for: each turn leaves a thousandth of the error.
  for (int turn = 0; turn < 5; ++turn) {
    const Interval offset = interval_at(node);
    node = passed - std::chrono::round<NodeTime>(Nanoseconds((offset.least + offset.most) / 2));
  }
  return is_possible(node) ? std::optional(node) : std::nullopt;
}

}  // namespace coupler::host
