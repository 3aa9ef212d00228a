// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/core/scheduled_writes.hpp"

#include <algorithm>

namespace coupler::host {
namespace {

using Outcome = WriteResult::Outcome;
using Kind = ScheduledOutcome::Result;

}  // namespace

ScheduledWrites::ScheduledWrites(Link& link, Writer& writer, ScheduledListener& outcomes)
    : link_(link), clock_(link.clock()), writer_(writer), outcomes_(outcomes) {}

void ScheduledWrites::add(const AcceptedWrite& what) {
  entries_.emplace_back(*this, what);
  find_due();
}

std::list<ScheduledWrites::Entry>::const_iterator ScheduledWrites::find(std::uint32_t number) const {
  return std::find_if(entries_.begin(), entries_.end(),
                      [number](const Entry& entry) { return entry.what.number == number; });
}

bool ScheduledWrites::has_point(std::uint32_t point) const {
  return std::any_of(entries_.begin(), entries_.end(),
                     [point](const Entry& entry) { return ScheduledWrites::point(entry) == point; });
}

std::vector<std::uint32_t> ScheduledWrites::numbers_of(const WritesFrom& which) const {
  std::vector<std::uint32_t> numbers;
  for (const Entry& entry : entries_)
    if (which.has(entry.what.what)) numbers.push_back(entry.what.number);
  return numbers;
}

Time ScheduledWrites::due(const Entry& entry) {
  return entry.state == Entry::State::waiting ? entry.what.what.due : Time::max();
}

void ScheduledWrites::find_due() {
  due_ = Time::max();
  for (const Entry& entry : entries_) due_ = std::min(due_, due(entry));
}

/// Returns the write to queue now: the first that is due, and among those due at the same time the one
/// accepted first.
ScheduledWrites::Entry* ScheduledWrites::next(Time now) {
  Entry* first = nullptr;
  for (Entry& entry : entries_)
    if (due(entry) <= now && (first == nullptr || due(entry) < due(*first))) first = &entry;
  return first;
}

void ScheduledWrites::queue_due(Time now) {
  if (now < due_) return;
  while (Entry* const entry = next(now)) queue(*entry);
  find_due();
}

void ScheduledWrites::queue(Entry& entry) {
  entry.state = Entry::State::being_written;
  Write write = entry.what.what.write;
  write.ordered = write.of_schedule = true;
  if (const ScheduledWrite& what = entry.what.what; what.may_be_late > Duration::zero())
    write.until = what.due + what.may_be_late;
  write.listener = &entry;
  queueing_ = true;
  try {
    writer_.push(write);
  } catch (...) {
    queueing_ = false;
    for (Entry& one : entries_)  // it has no place in the queue; or it is no more, since it has its outcome
      if (&one == &entry) one.state = Entry::State::waiting;
    throw;
  }
  queueing_ = false;
}

/// It has waited in the queue for longer than it may.
bool ScheduledWrites::is_too_late(const Entry& entry) const {
  const ScheduledWrite& what = entry.what.what;
  return what.may_be_late > Duration::zero() && clock_.now() >= what.due + what.may_be_late;
}

void ScheduledWrites::on_result(const Entry& entry, const WriteResult& result) {
  const Stamp written = link_.last_write();
  const Stamp now{clock_.now(), {}};
  const std::string why = to_string(result);
  switch (result.outcome) {
    case Outcome::ok: return finish(entry, Kind::done, written, {});
    case Outcome::lost: return finish(entry, Kind::unknown, now, why);
    case Outcome::superseded:
      return finish(entry, Kind::cancelled, now, to_string(modbus::Reason::safe_state));
    case Outcome::kept:
    case Outcome::dropped:
      if (queueing_ || is_too_late(entry)) break;
      return finish(entry, Kind::cancelled, now, to_string(modbus::Reason::connection));
    case Outcome::exception: return finish(entry, Kind::failed, written, why);
    case Outcome::not_taken:
    case Outcome::refused: break;
  }
  finish(entry, Kind::failed, now, why);
}

void ScheduledWrites::finish(const Entry& entry, ScheduledOutcome::Result result, Stamp at,
                             const std::string& reason) {
  const AcceptedWrite what = entry.what;
  remove(entry);
  outcomes_.on_outcome(what, result, at, reason);
}

void ScheduledWrites::remove(const Entry& entry) {
  entries_.remove_if([&entry](const Entry& other) { return &other == &entry; });
  find_due();
}

template <class Which>
void ScheduledWrites::cancel_if(Which which, Stamp at, const std::string& reason) {
  for (auto next = entries_.begin(); next != entries_.end();) {
    const Entry& entry = *next++;
    if (entry.state == Entry::State::waiting && which(entry)) finish(entry, Kind::cancelled, at, reason);
  }
}

void ScheduledWrites::on_written(const Write& write) {
  if (write.of_schedule) return;
  cancel_if([&write](const Entry& entry) { return point(entry) == write.point; }, link_.last_write(),
            to_string(modbus::Reason::overwritten));
}

void ScheduledWrites::on_made_safe(const std::vector<Write>& values) {
  const auto is_safe = [&values](const Entry& entry) {
    return std::any_of(values.begin(), values.end(),
                       [&entry](const Write& value) { return value.point == point(entry); });
  };
  cancel_if(is_safe, {clock_.now(), {}}, to_string(modbus::Reason::safe_state));
}

void ScheduledWrites::cancel(const std::string& reason) {
  cancel_if([](const Entry&) { return true; }, {clock_.now(), {}}, reason);
}

bool ScheduledWrites::cancel(std::uint32_t number, const std::string& reason) {
  const auto entry = find(number);
  if (entry == entries_.end()) return false;
  if (entry->state == Entry::State::being_written && !writer_.withdraw(*entry)) return false;
  finish(*entry, Kind::cancelled, {clock_.now(), {}}, reason);
  return true;
}

}  // namespace coupler::host
