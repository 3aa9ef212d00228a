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

bool goes_first(const Point& point) { return point.host.priority == HostOptions::Priority::high; }

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

WriteQueue::Class& WriteQueue::class_of(const Write& write) {
  return goes_first(map_.points[write.point]) ? high_ : normal_;
}

WriteQueue::Pushed WriteQueue::push(const Write& write) {
  const std::lock_guard lock(mutex_);
  return push_locked(write);
}

bool WriteQueue::push_together(Span<const Write> writes) {
  const std::lock_guard lock(mutex_);
  if (std::max(high_.ordered, normal_.ordered) + writes.size() > capacity) return false;
  for (const Write& write : writes) push_locked(write);
  return true;
}

WriteQueue::Pushed WriteQueue::push_locked(const Write& write) {
  if (write.until != Time::max()) any_may_be_late_ = true;
  Class& own = class_of(write);
  Waiting& waiting = waiting_[write.point];
  const bool ordered = is_ordered(write);
  const Index older = ordered ? waiting.ordered : waiting.number;
  if (older != none) {
    Place& place = places_[older];
    if (ordered ? joins(write, place.write) : place.number > own.last_ordered) {
      ++waiting.settled;  // the older one: the newer has its place
      return {true, std::exchange(place.write, write)};
    }
  }
  Pushed pushed;
  if (ordered) {
    if (own.ordered >= capacity) return {false, {}};
  } else if (older != none) {
    pushed.superseded = remove(older);
    settle(waiting);
  }
  const Index place = insert(write, ordered, none);
  if (ordered) {
    own.last_ordered = places_[place].number;
    waiting.ordered = place;
  } else {
    waiting.number = place;
  }
  ++waiting.pending;
  ++pending_writes_;
  return pushed;
}

void WriteQueue::take(WriteBatch& batch, bool merge, bool may_read) {
  const std::lock_guard lock(mutex_);
  Index& first = high_.first != none ? high_.first : normal_.first;
  const auto may_go = [&](const Write& write) {
    return (merge || batch.empty()) && (may_read || !needs_read(map_, map_.points[write.point]));
  };
  while (first != none && may_go(places_[first].write) && batch.add(places_[first].write)) remove(first);
}

std::optional<Write> WriteQueue::take() {
  const std::lock_guard lock(mutex_);
  if (first() == none) return std::nullopt;
  return remove(first());
}

template <class Which>
std::optional<Write> WriteQueue::take_if(Which which) {
  const std::lock_guard lock(mutex_);
  for (Index place = first(); place != none; place = next(place))
    if (which(places_[place].write)) return remove(place);
  return std::nullopt;
}

std::optional<Write> WriteQueue::take_one_of(const std::vector<bool>& points) {
  return take_if([&points](const Write& write) { return points[write.point]; });
}

std::optional<Write> WriteQueue::take_late(Time now) {
  if (!any_may_be_late_.load(std::memory_order_relaxed)) return std::nullopt;
  return take_if([now](const Write& write) { return write.until < now; });
}

std::optional<Write> WriteQueue::take_of(const WriteListener& listener) {
  return take_if([&listener](const Write& write) { return write.listener == &listener; });
}

void WriteQueue::put_back(const std::vector<Write>& writes) {
  const std::lock_guard lock(mutex_);
  for (auto write = writes.rbegin(); write != writes.rend(); ++write)
    insert(*write, true, class_of(*write).first);
}

void WriteQueue::settled(std::uint32_t point) {
  const std::lock_guard lock(mutex_);
  settle(waiting_[point]);
}

void WriteQueue::settle(Waiting& waiting) {
  --waiting.pending;
  ++waiting.settled;
  --pending_writes_;
}

std::uint32_t WriteQueue::queued(std::uint32_t point) const {
  const std::lock_guard lock(mutex_);
  return waiting_[point].settled + waiting_[point].pending;
}

bool WriteQueue::has_results(std::uint32_t point, std::uint32_t queued) const {
  const std::lock_guard lock(mutex_);
  const Waiting& waiting = waiting_[point];
  const std::uint32_t left = queued - waiting.settled;  // of those; it wraps when newer ones are settled
  return left == 0 || left > waiting.pending;
}

bool WriteQueue::is_pending(std::uint32_t point) const {
  const std::lock_guard lock(mutex_);
  return waiting_[point].pending != 0;
}

/// That behind it, in its class or in the next one.
WriteQueue::Index WriteQueue::next(Index place) const {
  return place == high_.last ? normal_.first : places_[place].behind;
}

/// Before the place `behind`, or at the end of its class if that is none.
WriteQueue::Index WriteQueue::insert(const Write& write, bool ordered, Index behind) {
  if (free_.empty()) {
    const std::size_t size = places_.size();
    places_.resize(std::max<std::size_t>(8, 2 * size));
    for (std::size_t i = places_.size(); i-- > size;) free_.push_back(static_cast<Index>(i));
  }
  const Index at = free_.back();
  free_.pop_back();
  Class& own = class_of(write);
  const Index before = behind == none ? own.last : places_[behind].before;
  places_[at] = {write, ordered, ++numbered_, before, behind};
  (before == none ? own.first : places_[before].behind) = at;
  (behind == none ? own.last : places_[behind].before) = at;
  own.ordered += ordered ? 1 : 0;
  ++size_now_;
  return at;
}

Write WriteQueue::remove(Index at) {
  const Place& place = places_[at];
  Class& own = class_of(place.write);
  (place.before == none ? own.first : places_[place.before].behind) = place.behind;
  (place.behind == none ? own.last : places_[place.behind].before) = place.before;
  own.ordered -= place.ordered ? 1 : 0;
  --size_now_;
  Waiting& waiting = waiting_[place.write.point];
  if (waiting.number == at) waiting.number = none;
  if (waiting.ordered == at) waiting.ordered = none;
  free_.push_back(at);
  return place.write;
}

}  // namespace coupler::host
