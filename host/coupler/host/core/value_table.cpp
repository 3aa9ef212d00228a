// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/core/value_table.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "coupler/codec/number.hpp"
#include "coupler/host/core/poll_deadlines.hpp"
#include "coupler/map/allowed_values.hpp"
#include "coupler/map/published.hpp"
#include "coupler/plan/planner.hpp"

namespace coupler::host {

using State = PointQuality::State;

namespace {

/// Returns the exponent in the registers of the point; nullopt if it is out of range.
std::optional<std::int16_t> exponent_in(const std::uint16_t* registers, const Point& point) {
  return codec::with_number(point.format.type, [&](auto zero) -> std::optional<std::int16_t> {
    const auto number = static_cast<double>(codec::take<decltype(zero)>(point.format, registers));
    if (std::fabs(number) > most_exponent) return std::nullopt;
    return static_cast<std::int16_t>(number);
  });
}

}  // namespace

ValueTable::ValueTable(const Map& map) : map_(map), entries_(map.points.size()) {
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    const Point& point = map.points[i];
    const modbus::Range range = read_range(point);
    Entry& entry = entries_[i];
    entry.first = registers_.size();
    entry.count = static_cast<std::uint16_t>(range.count());
    entry.start = range.start();
    entry.mask = own_bits(point);
    entry.stale_after = 2 * period_of(plan::rate_of(map, point)) + map.connection.timeout;
    registers_.resize(registers_.size() + host_registers(point));
    can_be_unusable_ |= !point.invalid.empty() || point.faults.present() || point.scale.has_exponent();
  }
  const auto place_of = [&](const Point& point) {
    return std::tuple(point.table, read_range(point).start());
  };
  for (const auto& [i, exponent] : points_with_exponent(map)) {
    entries_[i].scaling = static_cast<std::uint32_t>(scaling_.size());
    scaling_.push_back({i, exponent, place_of(map.points[i]) < place_of(map.points[exponent])});
  }
  late_.reserve(scaling_.size());
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
  late_.clear();
  ++stores_;
  for (const std::uint32_t point : span.points) {
    Entry& entry = entries_[point];
    entry.stored = stores_;
    const std::uint16_t* const read = &registers[entry.start - std::size_t{span.range.start()}];
    if (entry.scaling) continue;
    news |= take(entry, {read, stamp, good_at});
  }
  if (!scaling_.empty()) news |= store_scaled(span, registers, stamp, good_at);
  if (news) ++revision_;
  notify();
}

/// Stores the points of the span whose scale has an exponent, and those from before that have waited for
/// one of the span.
bool ValueTable::store_scaled(const ReadSpan& span, Span<const std::uint16_t> registers, Stamp stamp,
                              Time good_at) {
  bool news = false;
  for (const std::uint32_t point : span.points) {
    Entry& entry = entries_[point];
    if (!entry.scaling) continue;
    Scaling& scaling = scaling_[*entry.scaling];
    const std::uint16_t* const read = &registers[entry.start - std::size_t{span.range.start()}];
    const Entry& exponent = entries_[scaling.exponent];
    set_waits(scaling, scaling.comes_later && exponent.stored != stores_ && is_expected(exponent));
    if (scaling.waits) {
      std::copy_n(read, entry.count, scaling.registers.begin());
      scaling.stamp = stamp;
      scaling.good_at = good_at;
    } else {
      news |= take(entry, {read, stamp, good_at});
    }
  }
  if (waiting_ == 0) return news;
  for (Scaling& scaling : scaling_) {
    if (!scaling.waits || entries_[scaling.exponent].stored != stores_) continue;
    set_waits(scaling, false);
    news |= take(entries_[scaling.point], {scaling.registers.data(), scaling.stamp, scaling.good_at});
    late_.push_back(scaling.point);
  }
  return news;
}

/// Returns whether the state of the point has changed.
bool ValueTable::take(Entry& entry, const Taken& taken) {
  const Point& point = map_.points[static_cast<std::size_t>(&entry - entries_.data())];
  const State before = state_of(entry, taken.good_at);
  const bool was_usable = entry.read_as == State::good;
  const bool lacked_exponent = entry.lacks_exponent;
  entry.differs = entry.number == 0;
  for (std::size_t i = 0; i < entry.count; ++i)
    keep(entry, i, static_cast<std::uint16_t>(taken.registers[i] & entry.mask));
  entry.read_as = is_invalid(point, taken.registers) ? State::invalid
                  : is_fault(point, taken.registers) ? State::fault
                                                     : State::good;
  entry.lacks_exponent = false;
  if (entry.scaling && entry.read_as == State::good) {
    const auto power = exponent_of(scaling_[*entry.scaling], taken.good_at);
    entry.lacks_exponent = !power;
    if (power)
      keep(entry, entry.count, static_cast<std::uint16_t>(*power));
    else
      entry.read_as = State::invalid;
  }
  if (entry.differs) ++entry.number;
  entry.differs |= entry.read_as == State::good && !was_usable;
  entry.stamp = taken.stamp;
  mark_good(entry, taken.good_at);
  return lacked_exponent != entry.lacks_exponent || state_of(entry, taken.good_at) != before;
}

void ValueTable::keep(Entry& entry, std::size_t i, std::uint16_t now) {
  const std::uint16_t before = std::exchange(registers_[entry.first + i], now);
  entry.differs |= before != now;
}

/// Returns whether the point is asked for in each cycle.
bool ValueTable::is_expected(const Entry& entry) { return !entry.rejected && entry.why.empty(); }

void ValueTable::set_waits(Scaling& scaling, bool waits) {
  if (std::exchange(scaling.waits, waits) == waits) return;
  if (waits)
    ++waiting_;
  else
    --waiting_;
}

/// Ends the waiting of and for points that could not be read: the registers of the points themselves are
/// dropped, and points whose exponent is one of them become invalid.
void ValueTable::settle(Span<const std::uint32_t> points) {
  late_.clear();
  if (waiting_ == 0) return;
  const auto is_one = [&](std::uint32_t point) {
    return std::find(points.begin(), points.end(), point) != points.end();
  };
  for (Scaling& scaling : scaling_) {
    if (!scaling.waits) continue;
    if (is_one(scaling.point)) {
      set_waits(scaling, false);
    } else if (is_one(scaling.exponent)) {
      set_waits(scaling, false);
      take(entries_[scaling.point], {scaling.registers.data(), scaling.stamp, scaling.good_at});
      late_.push_back(scaling.point);
    }
  }
}

std::optional<std::int16_t> ValueTable::exponent_of(const Scaling& scaling, Time now) const {
  const Entry& exponent = entries_[scaling.exponent];
  if (read_state(exponent, now) != State::good) return std::nullopt;
  return exponent_in(&registers_[exponent.first], map_.points[scaling.exponent]);
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
    const State before = state_of(entry, at);
    const bool is_earlier = entry.number > 0 && !entry.last_good;
    mark_good(entry, at);
    if (is_earlier) entry.last_good.reset();
    news |= state_of(entry, at) != before;
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
  settle(points);
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
  settle(points);
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
  for (Scaling& scaling : scaling_) set_waits(scaling, false);
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

ValueTable::Value ValueTable::get(std::uint32_t point, Time now) const {
  const std::lock_guard lock(mutex_);
  const Entry& entry = entries_[point];
  const auto first = registers_.begin() + static_cast<std::ptrdiff_t>(entry.first);
  const std::size_t count = entry.number > 0 ? host_registers(map_.points[point]) : 0;
  return {{first, first + static_cast<std::ptrdiff_t>(count)},
          entry.stamp,
          entry.number,
          quality_of(entry, now),
          entry.read_as,
          why_unusable(entry, now)};
}

}  // namespace coupler::host
