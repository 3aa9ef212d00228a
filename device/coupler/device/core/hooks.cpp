// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/core/hooks.hpp"

#include <algorithm>

#include "coupler/device/core/each_point.hpp"

namespace coupler::device {

using modbus::Range;

namespace {

/// Returns whether the firmware is asked before the output is written; that of a line is then driven.
bool is_asked_about(const Point& point) {
  return is_hooked_output(point) || (is_writable(point) && point.line.present());
}

}  // namespace

HookedPoints::Indices HookedPoints::touched(Table table, Range range) const {
  const auto points = touched_points(map_, table, range);
  const auto first = static_cast<std::uint32_t>(points.begin() - map_.points.begin());
  return {first, first + static_cast<std::uint32_t>(points.size())};
}

Span<const std::uint16_t> HookedPoints::before(std::uint32_t point) const {
  const Point& which = map_.points[point];
  return image_.find(which.table, range(which));
}

/// If so, value_ holds what the point is to be.
bool HookedPoints::is_asked(std::uint32_t point, Range range, Span<const std::uint16_t> next) {
  const Point& which = map_.points[point];
  if (!is_asked_about(which)) return false;
  const auto now = before(point);
  std::copy(now.begin(), now.end(), value_.begin());
  const Range own = coupler::range(which);
  each_shared_address(own, range,
                      [&](std::uint32_t at) { value_[at - own.start()] = next[at - range.start()]; });
  return !is_partial(which) || ((value_[0] ^ now[0]) & codec::mask(which.format)) != 0;
}

bool HookedPoints::write(Table table, Range range, Span<const std::uint16_t> next) {
  const auto [first, end] = touched(table, range);
  for (std::uint32_t point = first; point < end; ++point) {
    if (!is_asked(point, range, next) || hooks_.accept(point, value_.data())) continue;
    take_back({first, point}, range, next);
    return false;
  }
  return true;
}

bool HookedPoints::write_each(Table table, Range range, Span<std::uint16_t> next) {
  bool good = true;
  const auto [first, end] = touched(table, range);
  for (std::uint32_t point = first; point < end; ++point) {
    if (has_hardware(map_.points[point]) || !is_asked(point, range, next)) continue;
    const auto now = before(point);
    if (std::equal(now.begin(), now.end(), value_.begin()) || hooks_.accept(point, value_.data())) continue;
    const Point& which = map_.points[point];
    const std::uint16_t mask = own_bits(which);
    const Range own = coupler::range(which);
    each_shared_address(own, range, [&](std::uint32_t at) {
      std::uint16_t& cell = next[at - range.start()];
      cell = static_cast<std::uint16_t>((cell & ~mask) | (now[at - own.start()] & mask));
    });
    good = false;
  }
  return good;
}

void HookedPoints::take_back(Table table, Range range, Span<const std::uint16_t> next) {
  take_back(touched(table, range), range, next);
}

/// The last one first, as one undoes.
void HookedPoints::take_back(Indices points, Range range, Span<const std::uint16_t> next) {
  for (std::uint32_t point = points.end; point-- > points.first;)
    if (is_asked(point, range, next)) (void)hooks_.accept(point, before(point).begin());
}

bool HookedPoints::has_output(Table table, Range range) const {
  const auto [first, end] = touched(table, range);
  return std::any_of(map_.points.begin() + first, map_.points.begin() + end, is_hooked_output);
}

bool HookedPoints::show_levels(bool are_news) {
  bool good = true;
  for (std::uint32_t i = 0; i < map_.points.size(); ++i)
    if (map_.points[i].line.present()) good &= hooks_.take_level(i, before(i)[0] != 0, are_news);
  return good;
}

void HookedPoints::begin_levels(const ChangeRing& ring) {
  heard_ = ring.newest();
  (void)show_levels(false);
}

bool HookedPoints::tell(const modbus::Change& change) {
  using modbus::Change;
  if (change.kind != Change::Kind::on && change.kind != Change::Kind::off) return true;
  const bool is_coil = change.table == static_cast<std::uint8_t>(modbus::Function::read_coils);
  const auto [point, end] =
      touched(is_coil ? Table::coils : Table::discrete_inputs, Range::of(change.address, 1));
  if (point == end || !map_.points[point].line.present()) return true;
  return hooks_.take_level(point, change.kind == Change::Kind::on, true);
}

bool HookedPoints::tell_levels(const ChangeRing& ring) {
  bool good = true;
  bool were_lost = false;
  while (const ChangeRing::Entry* entry = ring.next_after(heard_)) {
    were_lost |= entry->number != heard_ + 1;
    heard_ = entry->number;
    good &= tell(entry->change);
  }
  were_lost |= heard_ != ring.newest();
  heard_ = ring.newest();
  if (were_lost) good &= show_levels(true);
  return good;
}

}  // namespace coupler::device
