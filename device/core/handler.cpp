// SPDX-License-Identifier: Apache-2.0
#include "device/core/handler.hpp"

#include <algorithm>

#include "common/map/identity.hpp"
#include "common/modbus/reply.hpp"
#include "device/core/identity_area.hpp"
#include "device/core/map_file.hpp"

namespace coupler::node {
namespace {

using modbus::Exception;
using modbus::Function;

Table table_of(Function read) {
  switch (read) {
    case Function::read_coils: return Table::coils;
    case Function::read_discrete_inputs: return Table::discrete_inputs;
    case Function::read_input_registers: return Table::input_registers;
    default: return Table::holding_registers;
  }
}

void commit(const modbus::WriteRegisters& write, Span<std::uint16_t> cells) {
  for (std::size_t i = 0; i < cells.size(); ++i) cells[i] = modbus::get_u16(&write.values[2 * i]);
}

}  // namespace

Handler::Handler(const Map& map, Image& image, Lines& lines, Statistics& statistics)
    : map_(map), image_(image), lines_(lines), statistics_(statistics) {
  write_identity(map, image);
}

std::size_t Handler::handle(modbus::Bytes request, TimePoint now, Span<std::uint8_t> reply) {
  ++statistics_.requests;
  const Answer done = answer({request, now, reply});
  if (done) return *done;
  ++statistics_.exceptions;
  if (done.error() == Exception::server_device_failure) ++statistics_.hardware_errors;
  return modbus::reply_exception(request[0], done.error(), reply);
}

Handler::Answer Handler::answer(const Call& call) {
  const auto request = modbus::parse_request(call.request);
  if (!request) return tl::unexpected(request.error());
  return std::visit([&](const auto& what) { return carry_out(what, call); }, *request);
}

Handler::Answer Handler::carry_out(const modbus::Read& read, const Call& call) {
  const Table table = table_of(read.function);
  const auto cells = image_.find(table, read.range);
  if (cells.empty()) return tl::unexpected(Exception::illegal_data_address);
  if (table == Table::discrete_inputs && !lines_.read(read.range, cells, call.now))
    return tl::unexpected(Exception::server_device_failure);
  if (table == Table::input_registers && identity::reserved.overlaps(read.range))
    write_statistics(statistics_, call.now, image_);
  return holds_bits(table) ? modbus::reply_bits(read.function, cells, call.reply)
                           : modbus::reply_registers(read.function, cells, call.reply);
}

Handler::Answer Handler::carry_out(const modbus::WriteBits& write, const Call& call) {
  const auto cells = image_.find_writable(Table::coils, write.range);
  if (cells.empty()) return tl::unexpected(Exception::illegal_data_address);
  const auto bits = Span<std::uint16_t>(bits_).first(cells.size());
  for (std::size_t i = 0; i < bits.size(); ++i) bits[i] = write.packed[i / 8] >> i % 8 & 1;
  if (!lines_.drive(write.range, bits)) return tl::unexpected(Exception::server_device_failure);
  std::copy(bits.begin(), bits.end(), cells.begin());
  return modbus::reply_written(call.request, call.reply);
}

Handler::Answer Handler::carry_out(const modbus::WriteRegisters& write, const Call& call) {
  const auto cells = image_.find_writable(Table::holding_registers, write.range);
  if (cells.empty()) return tl::unexpected(Exception::illegal_data_address);
  commit(write, cells);
  return modbus::reply_written(call.request, call.reply);
}

Handler::Answer Handler::carry_out(const modbus::MaskWrite& write, const Call& call) {
  const auto cells = image_.find_writable(Table::holding_registers, write.range);
  if (cells.empty()) return tl::unexpected(Exception::illegal_data_address);
  cells[0] = static_cast<std::uint16_t>((cells[0] & write.and_mask) | (write.or_mask & ~write.and_mask));
  return modbus::reply_written(call.request, call.reply);
}

Handler::Answer Handler::carry_out(const modbus::ReadWriteRegisters& both, const Call& call) {
  const auto read = image_.find(Table::holding_registers, both.read);
  const auto written = image_.find_writable(Table::holding_registers, both.write.range);
  if (read.empty() || written.empty()) return tl::unexpected(Exception::illegal_data_address);
  commit(both.write, written);
  return modbus::reply_registers(Function::read_write_multiple_registers, read, call.reply);
}

Handler::Answer Handler::carry_out(const modbus::FileGroups& groups, const Call& call) {
  modbus::FileReply reply(call.reply);
  for (std::size_t i = 0; i < groups.size(); ++i) {
    const modbus::FileRecord group = groups[i];
    if (!read_map_file(map_.text, group, reply.add(group.registers)))
      return tl::unexpected(Exception::illegal_data_address);
  }
  return reply.size();
}

}  // namespace coupler::node
