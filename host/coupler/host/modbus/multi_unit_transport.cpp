// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/modbus/multi_unit_transport.hpp"

#include <array>

#include "coupler/host/modbus/bad_reply.hpp"
#include "coupler/host/modbus/modbus_transport.hpp"
#include "coupler/host/modbus/rtu_transport.hpp"
#include "coupler/map/functions.hpp"
#include "coupler/modbus/file_record.hpp"

namespace coupler::host {
namespace {

Result<> result(const tl::expected<void, modbus::ReplyError>& taken, modbus::Bytes asked,
                modbus::Bytes came) {
  if (taken) return {};
  if (taken.error().exception) return fail(ExceptionReply{*taken.error().exception});
  if (taken.error().other_value)
    return fail(ExceptionReply{static_cast<modbus::Exception>(0), taken.error().other_value});
  return fail(bad_reply("not the reply to this request", asked, came));
}

}  // namespace

Result<modbus::Bytes> MultiUnitTransport::exchange(modbus::Bytes pdu) {
  if (auto sent = send_pdu(pdu); !sent) return tl::make_unexpected(sent.error());
  return receive_pdu();
}

Result<> MultiUnitTransport::read_bits(Table table, modbus::Range range, std::uint8_t* bits) {
  const modbus::ReadRequest request(read_function(table), range);
  const auto reply = ask(request);
  if (!reply) return tl::make_unexpected(reply.error());
  return result(modbus::take_bits(request, *reply, bits), request.pdu(), *reply);
}

Result<> MultiUnitTransport::read_registers(Table table, modbus::Range range, std::uint16_t* registers) {
  const modbus::ReadRequest request(read_function(table), range);
  const auto reply = ask(request);
  if (!reply) return tl::make_unexpected(reply.error());
  return result(modbus::take_registers(request, *reply, registers), request.pdu(), *reply);
}

Result<> MultiUnitTransport::read_file_record(std::uint16_t file, std::uint16_t record,
                                              Span<std::uint16_t> registers) {
  std::array<std::uint8_t, modbus::file_request_size> pdu{};
  modbus::build_file_request({file, record, static_cast<std::uint16_t>(registers.size())}, pdu);
  const auto reply = exchange(pdu);
  if (!reply) return tl::make_unexpected(reply.error());
  return result(modbus::parse_file_reply(*reply, registers), pdu, *reply);
}

Result<> MultiUnitTransport::receive(const modbus::WriteRequest& request) {
  const auto reply = receive_pdu();
  if (!reply) return tl::make_unexpected(reply.error());
  return result(modbus::check_reply(request, *reply), request.pdu(), *reply);
}

std::unique_ptr<MultiUnitTransport> make_transport(const Connection& connection) {
  if (connection.is_rtu()) return std::make_unique<RtuTransport>(connection);
  return std::make_unique<ModbusTransport>(connection);
}

}  // namespace coupler::host
