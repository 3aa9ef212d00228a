// SPDX-License-Identifier: Apache-2.0
#include "host/modbus/exception_code.hpp"

#include <array>

#include "common/modbus/function.hpp"
#include "host/modbus/raw_exchange.hpp"

namespace coupler::driver {
namespace {

modbus::Function function_that_reads(Table table) {
  switch (table) {
    case Table::coils: return modbus::Function::read_coils;
    case Table::discrete_inputs: return modbus::Function::read_discrete_inputs;
    case Table::input_registers: return modbus::Function::read_input_registers;
    case Table::holding_registers: break;
  }
  return modbus::Function::read_holding_registers;
}

}  // namespace

Result<modbus::Exception> ask_for_exception(int socket, const modbus::Frame& to,
                                            std::chrono::milliseconds timeout, Table table,
                                            modbus::Range range) {
  std::array<std::uint8_t, 5> pdu{static_cast<std::uint8_t>(function_that_reads(table))};
  modbus::put_u16(&pdu[1], range.start());
  modbus::put_u16(&pdu[3], static_cast<std::uint16_t>(range.count()));
  const Deadline deadline(timeout);
  if (auto sent = send_request(socket, to, pdu); !sent) return tl::make_unexpected(sent.error());
  modbus::Framer framer;
  const auto reply = receive_reply(socket, to, timeout, deadline, framer);
  if (!reply) return tl::make_unexpected(reply.error());
  const bool refused = reply->size() == 2 && (*reply)[0] == (pdu[0] | modbus::exception_bit);
  return refused ? static_cast<modbus::Exception>((*reply)[1]) : modbus::Exception{};
}

}  // namespace coupler::driver
