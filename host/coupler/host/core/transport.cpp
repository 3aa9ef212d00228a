// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/core/transport.hpp"

#include <algorithm>
#include <array>

#include "coupler/map/functions.hpp"
#include "coupler/modbus/file_record.hpp"
#include "coupler/modbus/limits.hpp"

namespace coupler::host {
namespace {

template <class Taken>
Result<> result(const Taken& taken, modbus::Bytes asked, modbus::Bytes came) {
  if (taken) return {};
  return tl::make_unexpected(error_of(taken.error(), asked, came));
}

}  // namespace

Result<> Transport::read_bits(Table table, modbus::Range range, std::uint8_t* bits) {
  const modbus::ReadRequest request(read_function(table), range);
  const auto reply = exchange(request.pdu());
  if (!reply) return tl::make_unexpected(reply.error());
  return result(modbus::take_bits(request, *reply, bits), request.pdu(), *reply);
}

Result<> Transport::read_registers(Table table, modbus::Range range, std::uint16_t* registers) {
  const modbus::ReadRequest request(read_function(table), range);
  const auto reply = exchange(request.pdu());
  if (!reply) return tl::make_unexpected(reply.error());
  return result(modbus::take_registers(request, *reply, registers), request.pdu(), *reply);
}

Result<> Transport::read(Table table, modbus::Range range, std::uint16_t* values) {
  if (!holds_bits(table)) return read_registers(table, range, values);
  std::array<std::uint8_t, modbus::max_read_bits> bits{};
  Result<> answer = read_bits(table, range, bits.data());
  if (answer) std::copy_n(bits.begin(), range.count(), values);
  return answer;
}

Result<> Transport::read_file_record(std::uint16_t file, std::uint16_t record,
                                     Span<std::uint16_t> registers) {
  std::array<std::uint8_t, modbus::file_request_size> pdu{};
  modbus::build_file_request({file, record, static_cast<std::uint16_t>(registers.size())}, pdu);
  const auto reply = exchange(pdu);
  if (!reply) return tl::make_unexpected(reply.error());
  return result(modbus::parse_file_reply(*reply, registers), pdu, *reply);
}

Result<> Transport::receive() {
  const auto reply = receive_pdu();
  if (!reply) return tl::make_unexpected(reply.error());
  return {};
}

Result<modbus::ScheduleReply> Transport::schedule(const modbus::ScheduleRequest& request) {
  const auto reply = exchange(request.pdu());
  if (!reply) return tl::make_unexpected(reply.error());
  const auto parsed = modbus::parse_schedule_reply(*reply);
  if (!parsed) return tl::make_unexpected(error_of(parsed.error(), request.pdu(), *reply));
  return *parsed;
}

}  // namespace coupler::host
