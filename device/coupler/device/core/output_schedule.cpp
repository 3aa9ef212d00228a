// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/core/output_schedule.hpp"

#include <algorithm>
#include <atomic>
#include <cassert>
#include <tuple>
#include <utility>

#include "coupler/device/core/clock.hpp"

namespace coupler::device {

using modbus::Change;
using modbus::Range;
using modbus::Reason;
using State = ScheduledOutput::State;

std::uint16_t ScheduledOutput::value(std::size_t i) const {
  if (!holds_bits(table)) return modbus::get_u16(&packed[2 * i]);
  return static_cast<std::uint16_t>(packed[i / 8] >> i % 8 & 1);
}

void ScheduledOutput::set_value(std::size_t i, std::uint16_t value) {
  if (!holds_bits(table)) return modbus::put_u16(&packed[2 * i], value);
  const unsigned bit = 1U << i % 8;
  packed[i / 8] = static_cast<std::uint8_t>(value != 0 ? packed[i / 8] | bit : packed[i / 8] & ~bit);
}

OutputSchedule::OutputSchedule(Span<ScheduledOutput> places, ScheduleSink* sink, std::size_t pulses)
    : places_(places), pulses_(places.sub(places.size() - pulses, pulses)), sink_(sink) {
  for (ScheduledOutput& place : places_) {
    if (place.state == State::waiting) place.state = State::free;
    if (place.state != State::begun) continue;
    last_order_ = std::max(last_order_, place.order);
    any_overdue_ |= place.is_overdue;
  }
  find_earliest();
}

/// Durations cannot be cancelled, and their clients may be gone.
bool OutputSchedule::has_room_for(std::chrono::milliseconds duration) const {
  if (duration <= longest_short) return true;
  const Span<const ScheduledOutput> clients = places_.first(places_.size() - pulses_.size());
  const auto taken = std::count_if(clients.begin(), clients.end(), [](const ScheduledOutput& one) {
    return one.state != State::free && one.duration > longest_short;
  });
  return static_cast<std::size_t>(taken) < (clients.size() + 1) / 2;
}

ScheduledOutput* OutputSchedule::add(const modbus::ScheduleOutput& wanted, Table table, TimePoint due,
                                     const ClientSession& owner) {
  if (!has_room_for(wanted.duration)) return nullptr;
  const auto place = std::find_if(places_.begin(), pulses_.begin(),
                                  [](const ScheduledOutput& one) { return one.state == State::free; });
  if (place == pulses_.begin()) return nullptr;
  place->number = unused_number();
  place->state = State::waiting;
  place->safety = ScheduledOutput::Safety::unasked;
  place->is_overdue = false;
  place->table = table;
  place->range = wanted.range;
  place->at = due;
  place->duration = wanted.duration;
  place->order = ++last_order_;
  place->owner = &owner;
  std::copy(wanted.values.begin(), wanted.values.end(), place->packed.begin());
  ++waiting_;
  earliest_ = std::min(earliest_, due);
  return &*place;
}

std::uint16_t OutputSchedule::unused_number() {
  const auto is_used = [&](std::uint16_t number) {
    return std::any_of(places_.begin(), places_.end(), [&](const ScheduledOutput& one) {
      return one.state != State::free && one.number == number;
    });
  };
  do ++last_number_;
  while (last_number_ == 0 || is_used(last_number_));
  return last_number_;
}

ScheduledOutput* OutputSchedule::due(TimePoint now) {
  if (now < earliest_) return nullptr;
  const auto key = [](const ScheduledOutput& one) {
    return std::tuple(one.at, one.state != State::begun, one.order);
  };
  ScheduledOutput* first = nullptr;
  for (ScheduledOutput& one : places_)
    if (one.state != State::free && one.at <= now && (first == nullptr || key(one) < key(*first)))
      first = &one;
  return first;
}

void OutputSchedule::find_earliest() {
  earliest_ = TimePoint::max();
  for (const ScheduledOutput& one : places_)
    if (one.state != State::free) earliest_ = std::min(earliest_, one.at);
}

void OutputSchedule::begin(ScheduledOutput& which, TimePoint end, Span<const std::uint16_t> before) {
  for (std::size_t i = 0; i < before.size(); ++i) which.set_value(i, before[i]);
  which.at = end;
  which.order = ++last_order_;
  --waiting_;
  // Whoever goes on with it finds all of that, or one that waits and is dropped.
  std::atomic_signal_fence(std::memory_order_seq_cst);
  which.state = State::begun;
  find_earliest();
}

/// Null: it has none.
ScheduledOutput* OutputSchedule::pulse_of(std::uint16_t coil) {
  const auto found = std::find_if(pulses_.begin(), pulses_.end(), [coil](const ScheduledOutput& one) {
    return one.state == State::begun && one.range.start() == coil;
  });
  return found == pulses_.end() ? nullptr : &*found;
}

void OutputSchedule::pulse(std::uint16_t coil, TimePoint end) {
  ScheduledOutput* place = pulse_of(coil);
  const bool begins = place == nullptr;
  if (begins) {
    place = std::find_if(pulses_.begin(), pulses_.end(),
                         [](const ScheduledOutput& one) { return one.state == State::free; });
    assert(place != pulses_.end());  // each coil has one
    if (place == pulses_.end()) return;
  }
  place->safety = ScheduledOutput::Safety::unasked;
  place->is_overdue = false;
  place->order = ++last_order_;
  place->at = end;
  if (begins) {
    place->number = 0;
    place->table = Table::coils;
    place->range = Range::of(coil, 1);
    place->duration = {};
    place->owner = nullptr;
    place->set_value(0, 0);
    std::atomic_signal_fence(std::memory_order_seq_cst);  // as in begin()
    place->state = State::begun;
  }
  find_earliest();
}

void OutputSchedule::end_pulse(std::uint16_t coil) {
  if (ScheduledOutput* running = pulse_of(coil)) remove(*running);
}

void OutputSchedule::postpone(ScheduledOutput& which, TimePoint end) {
  which.at = end;
  find_earliest();
}

void OutputSchedule::retry(ScheduledOutput& which, TimePoint again) {
  which.is_overdue = true;
  any_overdue_ = true;
  postpone(which, again);
}

void OutputSchedule::remove(ScheduledOutput& which) {
  if (which.state == State::waiting) --waiting_;
  which.state = State::free;
  find_earliest();
}

void OutputSchedule::tell(const ScheduledOutput& which, Change::Kind kind, Reason reason, TimePoint at) {
  const Change outcome{static_cast<std::uint8_t>(reason), kind, which.number, node_time(at)};
  if (sink_ != nullptr) sink_->add_outcome(outcome, which.owner);
}

void OutputSchedule::tell_done(const ScheduledOutput& which, TimePoint at) {
  tell(which, Change::Kind::done, Reason::none, at);
}

void OutputSchedule::tell_failed(const ScheduledOutput& which, Reason reason, TimePoint at) {
  tell(which, Change::Kind::failed, reason, at);
}

template <class Which>
void OutputSchedule::cancel_if(Reason reason, TimePoint at, Which which) {
  if (waiting_ == 0) return;
  for (ScheduledOutput& one : places_) {
    if (one.state != State::waiting || !which(one)) continue;
    one.state = State::free;
    --waiting_;
    tell(one, Change::Kind::cancelled, reason, at);
  }
  find_earliest();
}

bool OutputSchedule::cancel(std::uint16_t number, const ClientSession& owner, TimePoint at) {
  const std::size_t before = waiting_;
  cancel_if(Reason::client, at,
            [&](const ScheduledOutput& one) { return one.number == number && one.owner == &owner; });
  return waiting_ != before;
}

std::size_t OutputSchedule::cancel_from(TimePoint from, Table table, Range range, const ClientSession& owner,
                                        TimePoint at) {
  const std::size_t before = waiting_;
  cancel_if(Reason::client, at, [&](const ScheduledOutput& one) {
    return one.owner == &owner && one.at >= from && one.table == table && one.range.overlaps(range);
  });
  return before - waiting_;
}

void OutputSchedule::cancel_of(const ClientSession& owner, TimePoint at) {
  cancel_if(Reason::connection, at, [&](const ScheduledOutput& one) { return one.owner == &owner; });
}

void OutputSchedule::cancel_overlapping(Table table, Range written, TimePoint at) {
  cancel_if(Reason::overwritten, at,
            [&](const ScheduledOutput& one) { return one.table == table && one.range.overlaps(written); });
}

void OutputSchedule::cancel_all(Reason reason, TimePoint at) {
  cancel_if(reason, at, [](const ScheduledOutput&) { return true; });
}

void OutputSchedule::outputs_went_safe(bool all, TimePoint now) {
  using Safety = ScheduledOutput::Safety;
  for (ScheduledOutput& one : places_) {
    if (one.state != State::begun) continue;
    one.safety = all ? Safety::reached : Safety::failed;
    // The value that was tried is from before the safe state. It is driven at once, so no write comes between
    // that it would undo.
    if (std::exchange(one.is_overdue, false)) one.at = now;
  }
  find_earliest();
}

void OutputSchedule::driven(Table table, Range range, Span<const std::uint16_t> cells) {
  if (!any_overdue_) return;
  for (ScheduledOutput& one : places_) {
    if (one.state != State::begun || !one.is_overdue || one.table != table) continue;
    each_shared_address(one.range, range, [&](std::uint32_t at) {
      // Else it is that of one that still runs, which ends with this one's value.
      if (are_overdue_after(one, at)) one.set_value(at - one.range.start(), cells[at - range.start()]);
    });
  }
}

/// All that began after `which` and have the address.
bool OutputSchedule::are_overdue_after(const ScheduledOutput& which, std::uint32_t address) {
  const ScheduledOutput* later = begun_after(which, address);
  while (later != nullptr && later->is_overdue) later = begun_after(*later, address);
  return later == nullptr;
}

ScheduledOutput* OutputSchedule::begun_after(const ScheduledOutput& which, std::uint32_t address) {
  ScheduledOutput* next = nullptr;
  for (ScheduledOutput& one : places_)
    if (one.state == State::begun && one.order > which.order && one.table == which.table &&
        one.range.contains(address) && (next == nullptr || one.order < next->order))
      next = &one;
  return next;
}

/// Considers only entries with this number in the order, or a higher one.
ScheduledOutput* OutputSchedule::first_begun(std::uint64_t order) {
  ScheduledOutput* first = nullptr;
  for (ScheduledOutput& one : places_)
    if (one.state == State::begun && one.order >= order && (first == nullptr || one.order < first->order))
      first = &one;
  return first;
}

}  // namespace coupler::device
