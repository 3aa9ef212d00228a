// SPDX-License-Identifier: Apache-2.0
// A Handler answers here whoever plays the machine around a simulated node (coupler/map/field_side.hpp).
#include "coupler/device/core/handler.hpp"

#include <algorithm>
#include <variant>

#include "coupler/device/core/each_point.hpp"
#include "coupler/map/field_side.hpp"
#include "coupler/map/functions.hpp"
#include "coupler/map/identity.hpp"

namespace coupler::device {

using modbus::Exception;

namespace {

bool is_identity(Table table, modbus::Range range) {
  return table == Table::input_registers && identity::reserved.overlaps(range);
}

}  // namespace

std::size_t Handler::handle_from_field(modbus::Bytes request, ClientSession& session, TimePoint now,
                                       Span<std::uint8_t> reply) {
  drive_due(now);
  take(now);
  const Answer done = answer_from_field({request, session, now, reply});
  return done ? *done : modbus::reply_exception(request[0], done.error(), reply);
}

Handler::Answer Handler::answer_from_field(const Call& call) {
  const auto request = modbus::parse_request(call.request);
  if (!request) return tl::unexpected(request.error());
  // Whoever plays the machine sees all of it.
  if (!rights_of(call.session).reads_all()) return tl::unexpected(no_right);
  if (const auto* read = std::get_if<modbus::Read>(&*request)) return read_from_field(*read, call);
  if (const auto* bits = std::get_if<modbus::WriteBits>(&*request)) {
    put_next(*bits);
    return set_inputs(Table::discrete_inputs, bits->range, call);
  }
  if (const auto* registers = std::get_if<modbus::WriteRegisters>(&*request)) {
    put_next(*registers);
    return set_inputs(Table::input_registers, registers->range, call);
  }
  return tl::unexpected(Exception::illegal_function);
}

Handler::Answer Handler::read_from_field(const modbus::Read& read, const Call& call) {
  const Table table = seen_from_field(table_of(read.function));
  const auto cells = image_.find(table, read.range);
  if (cells.empty() || is_identity(table, read.range)) return tl::unexpected(Exception::illegal_data_address);
  if (!read_hardware(table, read.range, cells, call.now)) return hardware_failed();
  return holds_bits(table) ? modbus::reply_bits(read.function, cells, call.reply)
                           : modbus::reply_registers(read.function, cells, call.reply);
}

bool Handler::is_free_input(const Point& point) const {
  return !point.counter.present() && !point.latched.present() &&
         !(hardware_.has_code() && is_set_by_firmware(point));
}

Handler::Answer Handler::set_inputs(Table table, modbus::Range range, const Call& call) {
  const auto cells = image_.find(table, range);
  const auto points = touched_points(map_, table, range);
  if (cells.empty() || is_identity(table, range) ||
      !std::all_of(points.begin(), points.end(), [&](const Point& point) { return is_free_input(point); }))
    return tl::unexpected(Exception::illegal_data_address);
  const auto next = Span<std::uint16_t>(next_).first(cells.size());
  if (holds_bits(table) && !hardware_.pull(range, next))
    return tl::unexpected(Exception::illegal_data_address);
  std::copy(next.begin(), next.end(), cells.begin());
  take(call.now);
  changes_.compare(table, range);
  return modbus::reply_written(call.request, call.reply);
}

}  // namespace coupler::device
