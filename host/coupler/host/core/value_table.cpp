// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/core/value_table.hpp"

#include <algorithm>
#include <utility>

#include "coupler/host/core/poll_deadlines.hpp"
#include "coupler/plan/planner.hpp"

namespace coupler::host {

using State = PointQuality::State;

ValueTable::ValueTable(const Map& map) : entries_(map.points.size()) {
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    const Point& point = map.points[i];
    const modbus::Range range = read_range(point);
    Entry& entry = entries_[i];
    entry.first = registers_.size();
    entry.count = static_cast<std::uint16_t>(range.count());
    entry.start = range.start();
    entry.mask = own_bits(point);
    entry.stale_after = 2 * period_of(plan::rate_of(map, point)) + map.connection.timeout;
    registers_.resize(registers_.size() + range.count());
  }
}

void ValueTable::begin() {
  const std::lock_guard lock(mutex_);
  online_ = false;
  heard_ = Time::min();
  for (Entry& entry : entries_) {
    entry.last_good.reset();
    entry.last_exception.reset();
    entry.last_write.reset();
    entry.last_write_text.clear();
    entry.why.clear();
    entry.failing = entry.rejected = entry.told = false;
  }
  ++revision_;
}

void ValueTable::store(const ReadSpan& span, Span<const std::uint16_t> registers, Stamp stamp, Time good_at) {
  const std::lock_guard lock(mutex_);
  bool news = false;
  for (const std::uint32_t point : span.points) {
    Entry& entry = entries_[point];
    news |= state_of(entry, good_at) != State::good;
    keep(entry, &registers[entry.start - std::size_t{span.range.start()}]);
    entry.stamp = stamp;
    mark_good(entry, good_at);
  }
  if (news) ++revision_;
  notify();
}

void ValueTable::keep(Entry& entry, const std::uint16_t* registers) {
  std::uint16_t* const own = &registers_[entry.first];
  entry.differs = entry.number == 0;
  for (std::size_t i = 0; i < entry.count; ++i) {
    const auto now = static_cast<std::uint16_t>(registers[i] & entry.mask);
    entry.differs |= std::exchange(own[i], now) != now;
  }
  if (entry.differs) ++entry.number;
}

void ValueTable::mark_good(Entry& entry, Time at) {
  entry.last_good = std::max(entry.last_good.value_or(at), at);
  entry.failing = entry.rejected = false;
  entry.why.clear();
}

/// A value from before begin() stays stale, since nothing newer is stored.
void ValueTable::good(Span<const std::uint32_t> points, Time at) {
  const std::lock_guard lock(mutex_);
  bool news = false;
  for (const std::uint32_t point : points) {
    Entry& entry = entries_[point];
    news |= state_of(entry, at) != State::good;
    const bool is_earlier = entry.number > 0 && !entry.last_good;
    mark_good(entry, at);
    if (is_earlier) entry.last_good.reset();
  }
  if (news) ++revision_;
}

void ValueTable::exception(Span<const std::uint32_t> points, modbus::Exception code) {
  const std::lock_guard lock(mutex_);
  for (const std::uint32_t point : points) {
    entries_[point].last_exception = code;
    entries_[point].failing = true;
    entries_[point].why.clear();
  }
  ++revision_;
}

void ValueTable::wrote(std::uint32_t point, const WriteResult& result) {
  if (result.outcome == WriteResult::Outcome::superseded) return;
  const std::lock_guard lock(mutex_);
  entries_[point].last_write = result.outcome;
  entries_[point].last_write_text = to_string(result);
  ++revision_;
}

void ValueTable::rejected(Span<const std::uint32_t> points, modbus::Exception code) {
  exception(points, code);
  const std::lock_guard lock(mutex_);
  for (const std::uint32_t point : points) entries_[point].rejected = true;
  ++revision_;
}

void ValueTable::set_aside(Span<const std::uint32_t> points, const std::string& why) {
  const std::lock_guard lock(mutex_);
  for (const std::uint32_t point : points) entries_[point].why = why;
  ++revision_;
}

void ValueTable::told(std::uint32_t point, bool told) {
  const std::lock_guard lock(mutex_);
  Entry& entry = entries_[point];
  if (std::exchange(entry.told, told) == told) return;
  if (!told && entry.last_good) entry.last_good = std::max(*entry.last_good, heard_);
  ++revision_;
}

void ValueTable::heard(Time at) {
  const std::lock_guard lock(mutex_);
  heard_ = at;
}

void ValueTable::connected() {
  const std::lock_guard lock(mutex_);
  for (Entry& entry : entries_) entry.failing = entry.rejected = false;
  ++revision_;
}

void ValueTable::online(bool online) {
  const std::lock_guard lock(mutex_);
  online_ = online;
  ++revision_;
  notify();
}

void ValueTable::notify() {
  if (waits_ > 0) changed_.notify_all();
}

bool ValueTable::is_since(const Entry& entry, Time since) const {
  return entry.number > 0 && entry.last_good && entry.stamp.at - entry.stamp.uncertainty >= since;
}

bool ValueTable::wait(std::uint32_t point, Time since, Time deadline, Offline offline) const {
  const Entry& entry = entries_[point];
  std::unique_lock lock(mutex_);
  ++waits_;
  changed_.wait_until(lock, deadline, [&] {
    return is_since(entry, since) || waits_end_ || (offline == Offline::gives_up && !online_);
  });
  --waits_;
  return is_since(entry, since);
}

void ValueTable::end_waits() {
  const std::lock_guard lock(mutex_);
  waits_end_ = true;
  notify();
}

State ValueTable::state_of(const Entry& entry, Time now) const {
  if (!online_) return State::offline;
  if (entry.rejected || !entry.why.empty()) return State::rejected;
  if (entry.failing) return State::exception;
  if (!entry.last_good) return entry.number > 0 ? State::stale : State::never_read;
  if (entry.told) return State::good;
  return now - *entry.last_good > entry.stale_after ? State::stale : State::good;
}

PointQuality ValueTable::quality_of(const Entry& entry, Time now) const {
  const State state = state_of(entry, now);
  const bool becomes_stale = state == State::good && !entry.told;
  const Time stale_from = becomes_stale ? *entry.last_good + entry.stale_after : Time::max();
  const bool was_true_then =
      entry.told && entry.last_good && (state == State::good || state == State::offline);
  const auto last_good = was_true_then ? std::max(*entry.last_good, heard_) : entry.last_good;
  return {
      state, stale_from, last_good, entry.last_exception, entry.why, entry.last_write, entry.last_write_text};
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

ValueTable::Value ValueTable::get(std::uint32_t point, Time now) const {
  const std::lock_guard lock(mutex_);
  const Entry& entry = entries_[point];
  const auto first = registers_.begin() + static_cast<std::ptrdiff_t>(entry.first);
  const std::size_t count = entry.number > 0 ? entry.count : 0;
  return {
      {first, first + static_cast<std::ptrdiff_t>(count)}, entry.stamp, entry.number, quality_of(entry, now)};
}

}  // namespace coupler::host
