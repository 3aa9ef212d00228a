// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/modbus/raw_exchange.hpp"

#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include <fmt/format.h>

namespace coupler::host {
namespace {

/// How many bytes the frame that has begun in `bytes` needs at least.
std::size_t missing(modbus::Bytes bytes) {
  constexpr std::size_t before_unit = modbus::mbap_size - 1;
  const std::size_t size =
      bytes.size() < before_unit ? before_unit : before_unit + modbus::get_u16(&bytes[4]);
  return size - bytes.size();
}

enum class Take { all, one_frame };

/// `has_begun`: bytes have come, so it is tried to receive them before it is waited, and the clock is read
/// only if there are not all of them: the rest comes within `timeout`.
Result<> receive_frame(int socket, std::chrono::milliseconds timeout, Deadline deadline,
                       modbus::Framer& framer, Take take, bool has_begun = false) {
  bool shortens = has_begun;
  for (bool waits = !has_begun;;) {
    const auto outcome = framer.next();
    if (outcome == modbus::Framer::Outcome::frame) return {};
    if (outcome == modbus::Framer::Outcome::bad) return fail(BadFrame{"not Modbus/TCP"});
    if (waits && std::exchange(shortens, false)) deadline = std::min(deadline, Deadline(timeout));
    pollfd wanted{socket, POLLIN, 0};
    if (waits && ::poll(&wanted, 1, deadline.left()) == 0) return fail(Timeout{timeout});
    const auto room = framer.room();
    const std::size_t most = take == Take::all ? room.size() : std::min(room.size(), missing(framer.rest()));
    const auto got = ::recv(socket, room.data(), most, 0);
    waits = got <= 0;
    if (got == 0) return fail(TransportFailure{"the device closed the connection"});
    if (got > 0)
      framer.filled(static_cast<std::size_t>(got));
    else if (errno != EAGAIN && errno != EINTR)
      return fail(TransportFailure{std::strerror(errno)});
  }
}

}  // namespace

Result<> check_header(const modbus::Frame& reply, const modbus::Frame& request) {
  if (reply.transaction != request.transaction) return fail(BadFrame{"the reply to another request"});
  if (reply.unit != request.unit)
    return fail(
        BadFrame{fmt::format("unit {0} answered a request to unit {1}; if the device is unit {0}, "
                             "set `unit: {0}`",
                             reply.unit, request.unit)});
  return {};
}

Result<> send_request(int socket, const modbus::Frame& to, modbus::Bytes pdu) {
  std::array<std::uint8_t, modbus::max_adu_size> adu{};
  modbus::put_header(to, pdu.size(), adu.data());
  std::copy(pdu.begin(), pdu.end(), adu.begin() + modbus::mbap_size);
  const std::size_t size = modbus::mbap_size + pdu.size();
  const auto sent = ::send(socket, adu.data(), size, MSG_NOSIGNAL | MSG_DONTWAIT);
  if (sent == static_cast<ssize_t>(size)) return {};
  return fail(TransportFailure{sent < 0 ? std::strerror(errno) : "only a part of the request could be sent"});
}

Result<modbus::Bytes> receive_reply(int socket, const modbus::Frame& to, std::chrono::milliseconds timeout,
                                    const Deadline& deadline, modbus::Framer& framer, bool has_begun) {
  if (auto received = receive_frame(socket, timeout, deadline, framer, Take::all, has_begun); !received)
    return tl::make_unexpected(received.error());
  const modbus::Frame& reply = framer.frame();
  if (auto answers = check_header(reply, to); !answers) return tl::make_unexpected(answers.error());
  if (framer.is_partial()) return fail(BadFrame{"more than one reply"});
  return reply.pdu;
}

Result<modbus::Bytes> receive_first_reply(int socket, const modbus::Frame& to,
                                          std::chrono::milliseconds timeout, const Deadline& deadline,
                                          modbus::Framer& framer) {
  if (auto received = receive_frame(socket, timeout, deadline, framer, Take::one_frame); !received)
    return tl::make_unexpected(received.error());
  if (auto answers = check_header(framer.frame(), to); !answers) return tl::make_unexpected(answers.error());
  return framer.frame().pdu;
}

}  // namespace coupler::host
