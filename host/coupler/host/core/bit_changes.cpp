// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/core/bit_changes.hpp"

#include <algorithm>
#include <utility>

#include "coupler/host/core/poll_deadlines.hpp"
#include "coupler/map/functions.hpp"
#include "coupler/plan/planner.hpp"

namespace coupler::host {
namespace {

/// An idle node is asked no more often than this, even if joint_rate is higher.
constexpr std::chrono::milliseconds shortest_joint_period(10);

std::uint32_t place(std::uint8_t function, std::uint16_t address) {
  return std::uint32_t{function} << 16 | address;
}

/// Returns a stamp that is not before the last stamp of the point. Its uncertainty includes the difference.
Stamp not_before(Stamp last, Stamp stamp) {
  if (stamp.at >= last.at) return stamp;
  return {last.at, stamp.uncertainty + (last.at - stamp.at)};
}

}  // namespace

BitChanges::BitChanges(const Map& map, PollCycle& cycle, Writer& writer, ValueTable& values, Sink& sink)
    : map_(map), cycle_(cycle), writer_(writer), values_(values), sink_(sink), index_(map.points.size()) {
  for (std::uint32_t i = 0; i < map.points.size(); ++i) {
    const Point& point = map.points[i];
    if (!holds_bits(point.table) || plan::why_not_read(map, point)) continue;
    const modbus::Range range = read_range(point);
    const auto index = static_cast<std::uint32_t>(points_.size());
    index_[i] = index;
    points_.push_back({i, bits_.size()});
    bits_.resize(bits_.size() + range.count());
    const auto function = static_cast<std::uint8_t>(read_function(point.table));
    for (std::uint32_t bit = 0; bit < range.count(); ++bit)
      at_.emplace_back(place(function, static_cast<std::uint16_t>(range.start() + bit)), index);
  }
  std::sort(at_.begin(), at_.end());
  one_.points.resize(1);
}

bool BitChanges::rests(const Told& told) const {
  return point_of(told).host.publish == HostOptions::Publish::on_change;
}

bool BitChanges::repeats(const Told& told) const {
  return told.known && rests(told) && point_of(told).host.max_interval.count() > 0;
}

Time BitChanges::repeat_at(Told& told) {
  if (!told.repeat_at) told.repeat_at = sink_.repeat_at(told.point);
  return *told.repeat_at;
}

void BitChanges::start(bool told) {
  active_ = told;
  newest_ = 0;
  more_follow_ = false;
  for (Told& point : points_) forget(point);
}

void BitChanges::forget(Told& told) {
  told.known = false;
  told.left_out = false;
  told.pending.reset();
  told.newer_than = 0;
  cycle_.rest(told.point, false);
  values_.told(told.point, false);
}

void BitChanges::want(std::uint32_t point, bool wanted) {
  cycle_.want(point, wanted);
  if (!active_ || !index_[point]) return;
  Told& told = points_[*index_[point]];
  if (!wanted)
    forget(told);
  else if (told.known)
    cycle_.read_soon(point);
}

const std::uint16_t* BitChanges::in(const ReadSpan& span, Span<const std::uint16_t> bits,
                                    const Told& told) const {
  return &bits[read_range(point_of(told)).start() - std::size_t{span.range.start()}];
}

bool BitChanges::leave_out(std::uint32_t point, const ReadSpan& span, Span<const std::uint16_t> bits) {
  if (!leaves_out_any() || !holds_bits(span.table)) return false;
  Told& told = points_[*index_[point]];
  if (!told.known) return false;
  const std::uint16_t* shown = &bits_[told.first];
  const std::size_t count = read_range(point_of(told)).count();
  if (!told.pending && std::equal(shown, shown + count, in(span, bits, told))) return false;
  told.left_out = rests(told);
  return true;
}

Stamp BitChanges::read(const ReadSpan& span, Span<const std::uint16_t> bits, Stamp stamp) {
  if (!active_ || !holds_bits(span.table)) return stamp;
  for (const std::uint32_t point : span.points) stamp = not_before(points_[*index_[point]].stamp, stamp);
  for (const std::uint32_t point : span.points) {
    Told& told = points_[*index_[point]];
    std::copy_n(in(span, bits, told), read_range(point_of(told)).count(), &bits_[told.first]);
    if (!std::exchange(told.known, true) || !more_follow_) told.newer_than = newest_;
    told.pending.reset();
    told.stamp = stamp;
    told.repeat_at.reset();
    if (!rests(told)) continue;
    cycle_.rest(point, true);
    values_.told(point, true);
  }
  return stamp;
}

void BitChanges::on_change(const modbus::Change& change, std::uint64_t number, Stamp stamp) {
  if (!change.is_bit()) return;
  const std::uint32_t here = place(change.table, change.address);
  for (auto at = std::lower_bound(at_.begin(), at_.end(), std::pair(here, 0U));
       at != at_.end() && at->first == here; ++at)
    this->change(points_[at->second], change, number, stamp);
}

void BitChanges::change(Told& told, const modbus::Change& change, std::uint64_t number, Stamp stamp) {
  if (!told.known || number <= told.newer_than) return;
  if (told.pending && change.at != told.pending_at) show_pending(told);
  const std::size_t bit = change.address - read_range(point_of(told)).start();
  bits_[told.first + bit] = change.kind == modbus::Change::Kind::on ? 1 : 0;
  if (point_of(told).count > 1 && !writer_.hides(told.point)) {
    told.pending = stamp;
    told.pending_at = change.at;
  } else {
    told.pending.reset();
    show_unless_hidden(told, stamp);
  }
}

void BitChanges::show_pending(Told& told) {
  if (told.pending) show_unless_hidden(told, *std::exchange(told.pending, std::nullopt));
}

void BitChanges::show_unless_hidden(Told& told, Stamp stamp) {
  if (writer_.hides(told.point))
    cycle_.rest(told.point, false);  // should the write fail, this is the value
  else
    show(told, stamp);
}

void BitChanges::show(Told& told, Stamp stamp) {
  told.stamp = not_before(told.stamp, stamp);
  told.repeat_at.reset();
  one_.table = point_of(told).table;
  one_.range = read_range(point_of(told));
  one_.points.front() = told.point;
  values_.store(one_, {&bits_[told.first], one_.range.count()}, told.stamp, told.stamp.at);
  sink_.on_told(told.point);
  writer_.shown(one_.points);
}

/// It may be another map, or other rights.
void BitChanges::on_new_epoch() { cycle_.try_again(); }

void BitChanges::on_gap() {
  for (Told& told : points_) {
    forget(told);
    cycle_.read_soon(told.point);
  }
  sink_.on_gap();
}

void BitChanges::on_heard(std::uint64_t newest, std::optional<Stamp> stamp) {
  newest_ = newest;
  more_follow_ = !stamp;
  if (!stamp) return leave_out_older_than_writes();
  for (Told& told : points_) {
    show_pending(told);
    if (std::exchange(told.left_out, false)) cycle_.read_soon(told.point);
  }
  values_.heard(stamp->at);
  heard_ = stamp->at;
  for (Told& told : points_)
    if (repeats(told) && repeat_at(told) <= stamp->at && !writer_.hides(told.point)) show(told, *stamp);
}

/// More changes follow, and are older than what waits to be written, too. Without them the bits are not those
/// of the device: nothing is shown of them until they are read.
void BitChanges::leave_out_older_than_writes() {
  if (!writer_.hides_any()) return;
  for (Told& told : points_) {
    if (!told.known || !writer_.hides(told.point)) continue;
    told.known = false;
    told.pending.reset();
    cycle_.read_soon(told.point);
  }
}

void BitChanges::on_end() {
  active_ = false;
  for (Told& told : points_) forget(told);
}

Time BitChanges::answer_wanted() {
  Time wanted = Time::max();
  if (!map_.tools.empty() || !map_.axes.empty())  // the stamps of joint positions are the times of answers
    wanted = heard_ + std::max<Duration>(period_of(map_.joint_rate), shortest_joint_period);
  for (Told& told : points_)
    if (repeats(told)) wanted = std::min(wanted, repeat_at(told));
  return wanted;
}

}  // namespace coupler::host
