// SPDX-License-Identifier: Apache-2.0
#include "host/modbus/file_exchange.hpp"

#include <poll.h>
#include <sys/socket.h>

#include <cerrno>
#include <cstring>

#include "common/modbus/frame.hpp"
#include "host/modbus/deadline.hpp"

namespace coupler::driver {
namespace {

/// One request is in flight at a time, so that any number does.
constexpr std::uint16_t transaction = 0x4F43;

Result<> send_request(int socket, std::uint8_t unit, modbus::FileRecord wanted) {
  std::array<std::uint8_t, modbus::mbap_size + modbus::file_request_size> adu{};
  const std::size_t pdu_size =
      modbus::build_file_request(wanted, {adu.data() + modbus::mbap_size, modbus::file_request_size});
  modbus::put_header({transaction, unit, {}}, pdu_size, adu.data());
  const auto sent = ::send(socket, adu.data(), adu.size(), MSG_NOSIGNAL);
  if (sent == static_cast<ssize_t>(adu.size())) return {};
  return fail(TransportFailure{sent < 0 ? std::strerror(errno) : "the request could not be sent whole"});
}

Result<> receive_frame(int socket, std::chrono::milliseconds timeout, modbus::Framer& framer) {
  const Deadline deadline(timeout);
  for (;;) {
    const auto outcome = framer.next();
    if (outcome == modbus::Framer::Outcome::frame) return {};
    if (outcome == modbus::Framer::Outcome::bad) return fail(BadFrame{"not Modbus/TCP"});
    pollfd wanted{socket, POLLIN, 0};
    if (::poll(&wanted, 1, deadline.left()) == 0) return fail(Timeout{timeout});
    const auto room = framer.room();
    const auto got = ::recv(socket, room.data(), room.size(), 0);
    if (got == 0) return fail(TransportFailure{"the device closed the connection"});
    if (got > 0)
      framer.filled(static_cast<std::size_t>(got));
    else if (errno != EAGAIN && errno != EINTR)
      return fail(TransportFailure{std::strerror(errno)});
  }
}

}  // namespace

Result<> exchange_file_record(int socket, std::uint8_t unit, std::chrono::milliseconds timeout,
                              modbus::FileRecord wanted, Span<std::uint16_t> registers) {
  if (auto sent = send_request(socket, unit, wanted); !sent) return sent;
  modbus::Framer framer;
  if (auto received = receive_frame(socket, timeout, framer); !received) return received;
  const modbus::Frame& reply = framer.frame();
  if (reply.transaction != transaction || reply.unit != unit)
    return fail(BadFrame{"the answer to another request"});
  const auto parsed = modbus::parse_file_reply(reply.pdu, registers);
  if (parsed) return {};
  if (parsed.error().exception) return fail(ExceptionReply{*parsed.error().exception});
  return fail(BadFrame{"not the file record that was asked for"});
}

}  // namespace coupler::driver
