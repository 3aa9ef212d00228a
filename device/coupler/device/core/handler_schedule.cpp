// SPDX-License-Identifier: Apache-2.0
// Outputs at a time.
#include <algorithm>

#include "coupler/device/core/handler.hpp"
#include "coupler/device/core/timed_output_end.hpp"
#include "coupler/map/functions.hpp"

namespace coupler::device {
namespace {

using modbus::Exception;
using modbus::Reason;

constexpr std::chrono::milliseconds most_past{1};
constexpr std::chrono::hours most_ahead{1};

TimePoint time_point(modbus::NodeTime time) {
  return TimePoint(std::chrono::duration_cast<TimePoint::duration>(time));
}

}  // namespace

/// Clients hear what became of it as they hear of changes.
bool Handler::can_schedule() const { return schedule_.is_present() && changes_.are_told(); }

TimePoint Handler::later(TimePoint now) const {
  return clock_ == nullptr ? now : std::max(now, clock_->now());
}

Span<std::uint16_t> Handler::writable(Table table, modbus::Range range) const {
  return table == Table::coils ? image_.find_writable(table, range) : writable_registers(range);
}

/// Returns the exception that a write of this value would get now.
tl::expected<void, Exception> Handler::check(const modbus::ScheduleOutput& wanted, Table table,
                                             const ClientSession& session) {
  if (writable(table, wanted.range).empty()) return tl::unexpected(Exception::illegal_data_address);
  if (!rights_of(session).may(Right::write, table, wanted.range)) return tl::unexpected(no_right);
  const auto next = Span<std::uint16_t>(next_).first(wanted.range.count());
  if (table == Table::coils)
    put_next(modbus::WriteBits{wanted.range, wanted.values});
  else
    put_next(modbus::WriteRegisters{wanted.range, wanted.values});
  if (is_forbidden(table, wanted.range)) return tl::unexpected(Exception::illegal_data_value);
  wrote_output_ = hardware_.driven(table, wanted.range, next);
  if (wrote_output_ && watchdog_.is_locked()) return tl::unexpected(Exception::server_device_failure);
  return hardware_.check(table, wanted.range, next);
}

Handler::Answer Handler::carry_out(const modbus::ScheduleOutput& wanted, const Call& call) {
  const modbus::NodeTime now = node_time(call.now);
  if (wanted.epoch != changes_.ring().epoch() || wanted.due < now - most_past ||
      wanted.due > now + most_ahead)
    return tl::unexpected(Exception::illegal_data_value);
  const Table table = table_of(wanted.table);
  if (const auto checked = check(wanted, table, call.session); !checked)
    return tl::unexpected(checked.error());
  const ScheduledOutput* accepted = schedule_.add(wanted, table, time_point(wanted.due), call.session);
  if (accepted == nullptr) return tl::unexpected(Exception::server_device_busy);
  if (wrote_output_) watchdog_.arm(call.now);
  return reply_schedule(accepted->number, call);
}

Handler::Answer Handler::carry_out(const modbus::CancelOutput& wanted, const Call& call) {
  if (wanted.epoch != changes_.ring().epoch()) return tl::unexpected(Exception::illegal_data_value);
  if (!schedule_.cancel(wanted.number, call.session, later(call.now)))
    return tl::unexpected(Exception::illegal_data_address);
  return reply_schedule(wanted.number, call);
}

Handler::Answer Handler::carry_out(const modbus::CancelOutputs& wanted, const Call& call) {
  if (wanted.epoch != changes_.ring().epoch()) return tl::unexpected(Exception::illegal_data_value);
  const std::size_t cancelled = schedule_.cancel_from(time_point(wanted.from), table_of(wanted.table),
                                                      wanted.range, call.session, later(call.now));
  return reply_schedule(static_cast<std::uint16_t>(cancelled), call);
}

Handler::Answer Handler::reply_schedule(std::uint16_t number, const Call& call) const {
  return modbus::reply_schedule({number, node_time(call.now), node_time(later(call.now))}, call.reply);
}

void Handler::drive_scheduled(TimePoint now) {
  if (now < next_scheduled()) return;
  changes_.set_time(now);
  while (ScheduledOutput* which = schedule_.due(now)) {
    if (which->state == ScheduledOutput::State::waiting)
      drive(*which, now);
    else
      end(*which, now);
  }
}

void Handler::drive(ScheduledOutput& which, TimePoint now) {
  const auto cells = image_.find(which.table, which.range);
  for (std::size_t i = 0; i < cells.size(); ++i) next_[i] = which.value(i);
  const bool lasts = which.duration.count() > 0;
  if (lasts) schedule_.begin(which, now + which.duration, cells);
  wrote_output_ = false;
  const auto driven = drive_and_store(which.table, which.range, cells, now);
  // Its client may be dead by now: this arms the watchdog, but does not feed it.
  if (wrote_output_ && watchdog_.state() != OutputWatchdog::State::armed) watchdog_.arm(now);
  const TimePoint at = later(now);
  if (driven)
    schedule_.tell_done(which, at);
  else
    schedule_.tell_failed(which, watchdog_.is_locked() ? Reason::locked : Reason::hardware, at);
  if (driven && lasts && has_pulses_ && which.table == Table::coils)
    follow_pulses(which.range, at, which.duration);
  if (driven && lasts)
    schedule_.postpone(which, at + which.duration);
  else
    schedule_.remove(which);
}

void Handler::end(ScheduledOutput& which, TimePoint now) {
  const auto [table, range] = std::pair(which.table, which.range);
  (void)TimedOutputEnd(map_, image_, hardware_, schedule_, next_).of(which, now);
  changes_.set_time(later(now));
  changes_.compare(table, range);
}

void Handler::end_session(const ClientSession& session, TimePoint now) {
  schedule_.cancel_of(session, later(now));
}

void Handler::end_schedule(TimePoint now) { schedule_.cancel_all(Reason::reload, later(now)); }

bool Handler::make_safe(Reason reason, TimePoint now) {
  schedule_.cancel_all(reason, later(now));
  const bool safe = drive_safe(now);
  const bool ended = TimedOutputEnd(map_, image_, hardware_, schedule_, next_).of_all(now);
  changes_.compare_all();
  return safe && ended;
}

}  // namespace coupler::device
