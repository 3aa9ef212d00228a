// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/modbus/multi_unit_transport.hpp"

#include "coupler/host/modbus/modbus_transport.hpp"
#include "coupler/host/modbus/rtu_transport.hpp"
#include "coupler/modbus/client.hpp"

namespace coupler::host {
namespace {

bool changes_outputs(modbus::Bytes pdu) {
  return pdu[0] == static_cast<std::uint8_t>(modbus::Function::schedule_output);
}

}  // namespace

Result<modbus::Bytes> MultiUnitTransport::exchange(modbus::Bytes pdu) {
  if (auto sent = send_pdu(pdu); !sent) return tl::make_unexpected(sent.error());
  auto reply = receive_pdu();
  if (reply && is_late() && !changes_outputs(pdu)) return fail(Timeout{timeout()});
  return reply;
}

Result<modbus::Bytes> MultiUnitTransport::receive_pdu() {
  auto reply = receive_reply();
  if (!reply) return reply;
  const auto answers = modbus::check_reply(sent(), *reply);
  if (!answers) return tl::make_unexpected(error_of(answers.error(), sent(), *reply));
  return reply;
}

std::unique_ptr<MultiUnitTransport> make_transport(const Connection& connection) {
  if (connection.is_rtu()) return std::make_unique<RtuTransport>(connection);
  return std::make_unique<ModbusTransport>(connection);
}

}  // namespace coupler::host
