// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/core/point_quality.hpp"

#include <algorithm>
#include <utility>

#include "coupler/host/core/poll_deadlines.hpp"
#include "coupler/plan/planner.hpp"

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
  }
  return "?";
}

PointQualities::PointQualities(const Map& map) : points_(map.points.size()) {
  for (std::size_t i = 0; i < points_.size(); ++i)
    points_[i].stale_after = 2 * period_of(plan::rate_of(map, map.points[i])) + map.connection.timeout;
}

void PointQualities::good(Span<const std::uint32_t> points, Time at) {
  const std::lock_guard lock(mutex_);
  bool news = false;
  for (const std::uint32_t point : points) {
    Entry& entry = points_[point];
    news |= state_of(entry, at) != State::good;
    entry.last_good = at;
    entry.failing = false;
    entry.why.clear();
  }
  if (news) ++revision_;
}

void PointQualities::exception(Span<const std::uint32_t> points, modbus::Exception code) {
  const std::lock_guard lock(mutex_);
  for (const std::uint32_t point : points) {
    points_[point].last_exception = code;
    points_[point].failing = true;
    points_[point].why.clear();
  }
  ++revision_;
}

void PointQualities::wrote(std::uint32_t point, const WriteResult& result) {
  if (result.outcome == WriteResult::Outcome::superseded) return;
  const std::lock_guard lock(mutex_);
  points_[point].last_write = result.outcome;
  points_[point].last_write_text = to_string(result);
  ++revision_;
}

void PointQualities::rejected(Span<const std::uint32_t> points, modbus::Exception code) {
  exception(points, code);
  const std::lock_guard lock(mutex_);
  for (const std::uint32_t point : points) points_[point].rejected = true;
  ++revision_;
}

void PointQualities::set_aside(Span<const std::uint32_t> points, const std::string& why) {
  const std::lock_guard lock(mutex_);
  for (const std::uint32_t point : points) points_[point].why = why;
  ++revision_;
}

void PointQualities::told(std::uint32_t point, bool told) {
  const std::lock_guard lock(mutex_);
  Entry& entry = points_[point];
  if (std::exchange(entry.told, told) == told) return;
  if (!told && entry.last_good) entry.last_good = std::max(*entry.last_good, heard_);
  ++revision_;
}

void PointQualities::heard(Time at) {
  const std::lock_guard lock(mutex_);
  heard_ = at;
}

void PointQualities::connected() {
  const std::lock_guard lock(mutex_);
  for (Entry& entry : points_) entry.failing = entry.rejected = false;
  ++revision_;
}

void PointQualities::online(bool online) {
  const std::lock_guard lock(mutex_);
  online_ = online;
  ++revision_;
}

State PointQualities::state_of(const Entry& entry, Time now) const {
  if (!online_) return State::offline;
  if (entry.rejected || !entry.why.empty()) return State::rejected;
  if (entry.failing) return State::exception;
  if (!entry.last_good) return State::never_read;
  if (entry.told) return State::good;
  return now - *entry.last_good > entry.stale_after ? State::stale : State::good;
}

PointQuality PointQualities::quality_of(const Entry& entry, Time now) const {
  const State state = state_of(entry, now);
  const bool becomes_stale = state == State::good && !entry.told;
  const Time stale_from = becomes_stale ? *entry.last_good + entry.stale_after : Time::max();
  const bool was_true_then =
      entry.told && entry.last_good && (state == State::good || state == State::offline);
  const auto last_good = was_true_then ? std::max(*entry.last_good, heard_) : entry.last_good;
  return {
      state, stale_from, last_good, entry.last_exception, entry.why, entry.last_write, entry.last_write_text};
}

std::vector<PointQuality> PointQualities::snapshot(Time now) const {
  const std::lock_guard lock(mutex_);
  std::vector<PointQuality> result;
  result.reserve(points_.size());
  for (const Entry& entry : points_) result.push_back(quality_of(entry, now));
  return result;
}

PointQuality PointQualities::of(std::uint32_t point, Time now) const {
  const std::lock_guard lock(mutex_);
  return quality_of(points_[point], now);
}

}  // namespace coupler::host
