// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/core/handler.hpp"

#include <algorithm>
#include <utility>

#include "coupler/device/core/identity.hpp"
#include "coupler/map/allowed_values.hpp"
#include "coupler/map/functions.hpp"
#include "coupler/map/identity.hpp"
#include "coupler/modbus/server.hpp"

namespace coupler::device {
namespace {

using modbus::Exception;
using modbus::Function;

/// Returns whether the range contains what the node says of all its clients.
bool shows_statistics(Table table, modbus::Range range) {
  constexpr auto statistics = modbus::Range::of(identity::reserved.start() + identity::at_statistics,
                                                identity::at_further - identity::at_statistics);
  return table == Table::input_registers && statistics.overlaps(range);
}

/// Returns whether a request concerns what a node has and a foreign coupler has not.
bool is_of_nodes(Function function) {
  switch (function) {
    case Function::read_file_record:
    case Function::encapsulated_interface:
    case Function::wait_for_changes:
    case Function::schedule_output: return true;
    default: return false;
  }
}

}  // namespace

Handler::Handler(const Map& map, Hardware hardware, const NodeState& state, const Clock* clock)
    : map_(map),
      image_(state.image),
      hardware_(hardware),
      statistics_(state.statistics),
      watchdog_(state.watchdog),
      changes_(state.changes),
      edge_points_(map, state.image, state.statistics, state.links, state.changes),
      schedule_(state.schedule),
      clock_(clock),
      shows_identity_(hardware.shows_identity()),
      hears_lines_(hardware.hears_lines()),
      forbids_values_(
          std::any_of(map.points.begin(), map.points.end(),
                      [](const Point& point) { return is_writable(point) && forbids_values(point); })),
      has_pulses_(std::any_of(map.points.begin(), map.points.end(), is_pulsed)) {
  set_machine({});
  show_outputs();
  if (has_pulses_) begin_pulses_that_are_missing();
}

void Handler::set_machine(const identity::Machine& machine) {
  if (!shows_identity_) return;
  machine_ = machine;
  identity::Functions functions;
  functions.tells_changes = changes_.are_told();
  functions.schedules_outputs = can_schedule();
  functions.has_field_side = has_field_side();
  write_identity(map_, machine_, functions, image_);
}

std::size_t Handler::handle(modbus::Bytes request, ClientSession& session, TimePoint now,
                            Span<std::uint8_t> reply) {
  drive_due(now);
  take(now);
  ++statistics_.requests;
  wrote_output_ = false;
  const Answer done = answer({request, session, now, reply});
  if (done) {
    watchdog_.request(session, wrote_output_, now);
    return *done;
  }
  ++statistics_.exceptions;
  const auto which = static_cast<std::size_t>(done.error()) - 1;
  if (which < identity::exceptions_of.size()) ++(statistics_.*identity::exceptions_of[which]);
  return modbus::reply_exception(request[0], done.error(), reply);
}

void Handler::tick(TimePoint now) {
  drive_due(now);
  // A firmware may have set values since; it wakes the loop once for all of them.
  const bool are_taken = std::exchange(took_news_, false) && !hardware_.has_code();
  if (!are_taken && wants_news(now)) take(now);
}

/// The watchdog first: what it cancels is not driven.
void Handler::drive_due(TimePoint now) {
  if (watchdog_.is_due(now)) expire_watchdog(now);
  drive_scheduled(now);
  drive_wanted(now);
}

void Handler::expire_watchdog(TimePoint now) {
  if (watchdog_.state() == OutputWatchdog::State::armed) ++statistics_.watchdog_trips;
  watchdog_.expire(drive_safe(now), now);
  schedule_.cancel_all(modbus::Reason::watchdog, later(now));
}

bool Handler::drive_safe(TimePoint now) {
  // If this process dies while they are driven, the next one brings none of them back.
  schedule_.outputs_went_safe(false, now);
  const bool is_safe = hardware_.drive_safe();
  changes_.set_time(later(now));
  show_outputs();
  schedule_.outputs_went_safe(is_safe, now);
  return is_safe;
}

std::optional<std::chrono::milliseconds> Handler::time_until_due(TimePoint now) const {
  using std::chrono::milliseconds;
  TimePoint due = std::min(watchdog_.deadline().value_or(TimePoint::max()), next_scheduled());
  if (wants_news(now)) due = std::min(due, hardware_.next_change(now).value_or(TimePoint::max()));
  if (due == TimePoint::max()) return std::nullopt;
  return std::max(milliseconds(0), std::chrono::ceil<milliseconds>(due - now));
}

void Handler::show_outputs() {
  for (const Image::Area& area : image_.mapped(Table::coils)) {
    const auto range = modbus::Range::of(area.start, area.end - area.start);
    hardware_.driven(Table::coils, range, image_.find(Table::coils, range));
    changes_.compare(Table::coils, range);
  }
}

Handler::Answer Handler::hardware_failed() {
  ++statistics_.hardware_errors;
  return tl::unexpected(Exception::server_device_failure);
}

Handler::Answer Handler::answer(const Call& call) {
  const auto function = static_cast<Function>(call.request[0]);
  if (function == Function::schedule_output && !can_schedule())
    return tl::unexpected(Exception::illegal_function);
  if (!shows_identity_ && is_of_nodes(function)) return tl::unexpected(Exception::illegal_function);
  const auto request = modbus::parse_request(call.request);
  if (!request) return tl::unexpected(request.error());
  return std::visit([&](const auto& what) { return carry_out(what, call); }, *request);
}

Handler::Answer Handler::carry_out(const modbus::Read& read, const Call& call) {
  const Table table = table_of(read.function);
  const auto cells = image_.find_readable(table, read.range);
  if (cells.empty()) return tl::unexpected(Exception::illegal_data_address);
  if (!rights_of(call.session).may(Right::read, table, read.range)) return tl::unexpected(no_right);
  if (shows_statistics(table, read.range) && !rights_of(call.session).reads_all())
    return tl::unexpected(no_right);
  if (const auto refused = hardware_.refuse_read(table, read.range)) return tl::unexpected(*refused);
  if (!read_hardware(table, read.range, cells, call.now)) return hardware_failed();
  if (table == Table::input_registers && identity::reserved.overlaps(read.range)) {
    if (!shows_identity_) return tl::unexpected(Exception::illegal_data_address);
    write_statistics(statistics_, call.now, image_);
    write_watchdog(watchdog_, call.now, image_);
  }
  return holds_bits(table) ? modbus::reply_bits(read.function, cells, call.reply)
                           : modbus::reply_registers(read.function, cells, call.reply);
}

Handler::Answer Handler::carry_out(const modbus::FileGroups& groups, const Call& call) {
  modbus::FileReply reply(call.reply);
  for (std::size_t i = 0; i < groups.size(); ++i) {
    const modbus::FileRecord group = groups[i];
    if (!read_map_file(map_.text, group, reply.add(group.registers)))
      return tl::unexpected(Exception::illegal_data_address);
  }
  if (!rights_of(call.session).reads_all()) return tl::unexpected(no_right);
  return reply.size();
}

Handler::Answer Handler::carry_out(const modbus::Echo&, const Call& call) {
  std::copy(call.request.begin(), call.request.end(), call.reply.begin());
  return call.request.size();
}

Handler::Answer Handler::carry_out(const modbus::ReadDeviceIdentification& wanted, const Call& call) {
  return identify(map_, machine_, wanted, call.reply);
}

}  // namespace coupler::device
