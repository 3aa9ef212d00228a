// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/modbus/file_exchange.hpp"

#include <array>

#include "coupler/host/modbus/raw_exchange.hpp"

namespace coupler::host {

Result<> exchange_file_record(int socket, const modbus::Frame& to, std::chrono::milliseconds timeout,
                              modbus::FileRecord wanted, Span<std::uint16_t> registers) {
  std::array<std::uint8_t, modbus::file_request_size> pdu{};
  modbus::build_file_request(wanted, pdu);
  const Deadline deadline(timeout);
  if (auto sent = send_request(socket, to, pdu); !sent) return sent;
  modbus::Framer framer;
  const auto reply = receive_reply(socket, to, timeout, deadline, framer);
  if (!reply) return tl::make_unexpected(reply.error());
  const auto parsed = modbus::parse_file_reply(*reply, registers);
  if (parsed) return {};
  if (parsed.error().exception) return fail(ExceptionReply{*parsed.error().exception});
  return fail(BadFrame{"not the file record that was asked for"});
}

}  // namespace coupler::host
