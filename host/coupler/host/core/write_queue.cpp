// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/core/write_queue.hpp"

#include <algorithm>
#include <utility>

namespace coupler::host {
namespace {

bool is_number(const Point& point) {
  if (holds_bits(point.table)) return false;
  switch (point.format.type) {
    case codec::Type::BOOL:
    case codec::Type::BYTE:
    case codec::Type::WORD:
    case codec::Type::DWORD:
    case codec::Type::LWORD:
    case codec::Type::CHAR:
    case codec::Type::STRING: return false;
    default: return true;
  }
}

bool sends_every_value(const Point& point) {
  return point.host.write_queue == HostOptions::WriteQueue::every;
}

}  // namespace

WriteQueue::WriteQueue(const Map& map) : map_(map), waiting_(map.points.size()) {}

bool WriteQueue::is_ordered(const Write& write) const {
  const Point& point = map_.points[write.point];
  return write.ordered || !is_number(point) || sends_every_value(point);
}

bool WriteQueue::joins(const Write& newer, const Write& older) const {
  return !newer.ordered && !older.ordered && !sends_every_value(map_.points[newer.point]) &&
         newer.registers == older.registers;
}

WriteQueue::Pushed WriteQueue::push(const Write& write) {
  const std::lock_guard lock(mutex_);
  Waiting& waiting = waiting_[write.point];
  const bool ordered = is_ordered(write);
  const Index older = ordered ? waiting.ordered : waiting.number;
  if (older != none) {
    Place& place = places_[older];
    if (ordered ? joins(write, place.write) : place.number > last_ordered_)
      return {true, std::exchange(place.write, write)};
  }
  Pushed pushed;
  if (ordered) {
    if (ordered_ >= capacity) return {false, {}};
  } else if (older != none) {
    pushed.superseded = remove(older);
    --waiting.pending;
    --pending_writes_;
  }
  const Index place = insert(write, ordered, none);
  if (ordered) {
    last_ordered_ = places_[place].number;
    waiting.ordered = place;
  } else {
    waiting.number = place;
  }
  ++waiting.pending;
  ++pending_writes_;
  return pushed;
}

void WriteQueue::take(WriteBatch& batch, bool merge) {
  const std::lock_guard lock(mutex_);
  while (first_ != none && (merge || batch.empty()) && batch.add(places_[first_].write)) remove(first_);
}

std::optional<Write> WriteQueue::take() {
  const std::lock_guard lock(mutex_);
  if (first_ == none) return std::nullopt;
  return remove(first_);
}

std::optional<Write> WriteQueue::take_one_of(const std::vector<bool>& points) {
  const std::lock_guard lock(mutex_);
  for (Index place = first_; place != none; place = places_[place].behind)
    if (points[places_[place].write.point]) return remove(place);
  return std::nullopt;
}

void WriteQueue::put_back(const std::vector<Write>& writes) {
  const std::lock_guard lock(mutex_);
  for (auto write = writes.rbegin(); write != writes.rend(); ++write) insert(*write, true, first_);
}

void WriteQueue::settled(std::uint32_t point) {
  const std::lock_guard lock(mutex_);
  --waiting_[point].pending;
  --pending_writes_;
}

bool WriteQueue::is_pending(std::uint32_t point) const {
  const std::lock_guard lock(mutex_);
  return waiting_[point].pending != 0;
}

/// Before the place `behind`, or at the end if that is none.
WriteQueue::Index WriteQueue::insert(const Write& write, bool ordered, Index behind) {
  if (free_.empty()) {
    const std::size_t size = places_.size();
    places_.resize(std::max<std::size_t>(8, 2 * size));
    for (std::size_t i = places_.size(); i-- > size;) free_.push_back(static_cast<Index>(i));
  }
  const Index at = free_.back();
  free_.pop_back();
  const Index before = behind == none ? last_ : places_[behind].before;
  places_[at] = {write, ordered, ++numbered_, before, behind};
  (before == none ? first_ : places_[before].behind) = at;
  (behind == none ? last_ : places_[behind].before) = at;
  ordered_ += ordered ? 1 : 0;
  ++size_now_;
  return at;
}

Write WriteQueue::remove(Index at) {
  const Place& place = places_[at];
  (place.before == none ? first_ : places_[place.before].behind) = place.behind;
  (place.behind == none ? last_ : places_[place.behind].before) = place.before;
  ordered_ -= place.ordered ? 1 : 0;
  --size_now_;
  Waiting& waiting = waiting_[place.write.point];
  if (waiting.number == at) waiting.number = none;
  if (waiting.ordered == at) waiting.ordered = none;
  free_.push_back(at);
  return place.write;
}

}  // namespace coupler::host
