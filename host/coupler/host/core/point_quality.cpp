// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/core/point_quality.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "coupler/host/core/value_table.hpp"
#include "coupler/host/core/value_text.hpp"
#include "coupler/map/published.hpp"

namespace coupler::host {

using State = PointQuality::State;

std::string_view to_string(State state) {
  switch (state) {
    case State::good: return "good";
    case State::stale: return "stale";
    case State::never_read: return "never read";
    case State::exception: return "exception";
    case State::rejected: return "rejected";
    case State::offline: return "offline";
    case State::not_wanted: return "not wanted";
    case State::invalid: return "invalid";
    case State::fault: return "fault";
  }
  return "?";
}

State ValueTable::state_of(const Entry& entry, Time now) const {
  return online_ ? read_state(entry, now) : State::offline;
}

/// Returns the state of the point while the device is online. Values are stored before the device counts as
/// online.
State ValueTable::read_state(const Entry& entry, Time now) const {
  if (entry.rejected || !entry.why.empty()) return State::rejected;
  if (entry.failing) return State::exception;
  if (!entry.last_good) return entry.number > 0 ? State::stale : State::never_read;
  if (!entry.told && now - *entry.last_good > entry.stale_after) return State::stale;
  return entry.read_as;
}

PointQuality ValueTable::quality_of(const Entry& entry, Time now) const {
  const State state = state_of(entry, now);
  const bool becomes_stale = (state == State::good || PointQuality::is_unusable(state)) && !entry.told;
  const Time stale_from = becomes_stale ? *entry.last_good + entry.stale_after : Time::max();
  return {state,
          stale_from,
          last_good_of(entry, state),
          entry.last_exception,
          PointQuality::is_unusable(state) ? why_unusable(entry, now) : entry.why,
          entry.last_write,
          entry.last_write_text};
}

std::optional<Time> ValueTable::last_good_of(const Entry& entry, State state) const {
  const bool was_true_when_heard =
      entry.told && entry.last_good && (state == State::good || state == State::offline);
  return was_true_when_heard ? std::max(*entry.last_good, heard_) : entry.last_good;
}

std::string ValueTable::why_unusable(const Entry& entry, Time now) const {
  const Point& point = map_.points[static_cast<std::size_t>(&entry - entries_.data())];
  if (entry.read_as == State::good) return {};
  if (!entry.lacks_exponent) return unusable_text(&registers_[entry.first], point);
  const std::uint32_t power = scaling_[*entry.scaling].exponent;
  const Entry& exponent = entries_[power];
  if (read_state(exponent, now) == State::good)
    return fmt::format("{} is {}, which is out of range for an exponent ({} to {})", point.scale.exponent_of,
                       format_value(&registers_[exponent.first], map_.points[power]), -most_exponent,
                       most_exponent);
  return fmt::format("{}, the exponent of its scale, has no value", point.scale.exponent_of);
}

std::vector<PointQuality> ValueTable::qualities(Time now) const {
  std::vector<PointQuality> result;
  result.reserve(entries_.size());
  const std::lock_guard lock(mutex_);
  for (const Entry& entry : entries_) result.push_back(quality_of(entry, now));
  return result;
}

PointQuality ValueTable::quality(std::uint32_t point, Time now) const {
  const std::lock_guard lock(mutex_);
  return quality_of(entries_[point], now);
}

ValueTable::Freshness ValueTable::freshness(std::uint32_t point, Time now) const {
  const std::lock_guard lock(mutex_);
  const Entry& entry = entries_[point];
  const State state = state_of(entry, now);
  return {state, last_good_of(entry, state), entry.number};
}

PointQuality::State ValueTable::state_when_online(std::uint32_t point, Time now) const {
  const std::lock_guard lock(mutex_);
  return read_state(entries_[point], now);
}

}  // namespace coupler::host
