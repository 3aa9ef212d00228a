// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/modbus/raw_exchange.hpp"

#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <utility>
#include <vector>

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

/// A reply to a read begins with so much: the header, the function code, and the byte count or the exception.
constexpr std::size_t beginning_size = modbus::mbap_size + 2;

/// Something with the right transaction is the reply, however wrong the rest is; a TLS alert tells what is
/// wrong, too.
bool begins_reply(modbus::Bytes bytes, const modbus::Frame& to) {
  constexpr std::uint16_t tls_alert = 0x1503;
  const auto begins = bytes.size() < 2 ? 0 : modbus::get_u16(bytes.data());
  return bytes.size() >= 2 && (begins == to.transaction || begins == tls_alert);
}

/// Whether a reply to a read with this function code may begin so, as far as it has come.
bool may_begin_reply(modbus::Bytes bytes, const modbus::Frame& to, std::uint8_t asked) {
  if (begins_reply(bytes, to)) return true;
  // The protocol, and the high byte of the length.
  for (std::size_t i = 2; i < std::min<std::size_t>(bytes.size(), 5); ++i)
    if (bytes[i] != 0) return false;
  if (bytes.size() > 6 && bytes[6] != to.unit) return false;
  if (bytes.size() < beginning_size) return bytes.size() < 8 || (bytes[7] & 0x7FU) == asked;
  return bytes[7] == asked ? bytes[5] == 3 + bytes[8] : bytes[7] == (asked | 0x80U) && bytes[5] == 3;
}

/// False: no more comes. Where a part of a reply is there, poll() would not wait for the rest.
bool await_more(int socket, bool has_begun, const Deadline& deadline) {
  pollfd more{socket, static_cast<short>(has_begun ? POLLRDHUP : POLLIN), 0};
  ::poll(&more, 1, has_begun ? 1 : deadline.left());
  return !has_begun || more.revents == 0;
}

/// Of what has come so far, so many bytes are before the reply.
std::size_t size_before_reply(modbus::Bytes bytes, const modbus::Frame& to, std::uint8_t asked) {
  std::size_t first = 0;
  while (first < bytes.size() && !may_begin_reply({&bytes[first], bytes.size() - first}, to, asked)) ++first;
  return first;
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
    if (outcome == modbus::Framer::Outcome::bad)
      return fail(BadFrame{"not Modbus/TCP: " + shown_bytes(framer.rest())});
    if (waits && std::exchange(shortens, false)) deadline = std::min(deadline, Deadline(timeout));
    pollfd wanted{socket, POLLIN, 0};
    if (waits && ::poll(&wanted, 1, deadline.left()) == 0) return fail(Timeout{timeout});
    const auto room = framer.room();
    const std::size_t most = take == Take::all ? room.size() : std::min(room.size(), missing(framer.rest()));
    const auto got = ::recv(socket, room.data(), most, 0);
    waits = got <= 0;
    if (got == 0 || (got < 0 && errno == ECONNRESET)) return fail(closed_instead_of_reply());
    if (got > 0)
      framer.filled(static_cast<std::size_t>(got));
    else if (errno != EAGAIN && errno != EINTR)
      return fail(TransportFailure{std::strerror(errno)});
  }
}

}  // namespace

std::string shown_bytes(modbus::Bytes bytes) {
  constexpr std::size_t most = 16;
  std::string text;
  for (std::size_t i = 0; i < std::min(bytes.size(), most); ++i)
    text += fmt::format("{}{:02x}", i > 0 ? " " : "", bytes[i]);
  return bytes.size() > most ? fmt::format("{} … ({} bytes)", text, bytes.size()) : text;
}

BadFrame bad_reply(std::string_view what, modbus::Bytes asked, modbus::Bytes came) {
  return {fmt::format("{}; asked {}, got {}", what, shown_bytes(asked), shown_bytes(came))};
}

Result<> check_header(const modbus::Frame& reply, const modbus::Frame& request) {
  if (reply.transaction != request.transaction)
    return fail(BadFrame{fmt::format("the reply to another request: transaction {}, where {} was asked",
                                     reply.transaction, request.transaction)});
  if (reply.unit != request.unit)
    return fail(
        BadFrame{fmt::format("unit {0} answered a request to unit {1}; if the device is unit {0}, "
                             "set `unit: {0}`",
                             reply.unit, request.unit)});
  return {};
}

Result<> skip_to_reply(int socket, const modbus::Frame& to, std::uint8_t asked, const Deadline& deadline,
                       std::uint64_t& discarded) {
  constexpr std::uint64_t most = 16384;
  std::uint64_t skipped = 0;
  std::vector<std::uint8_t> first_bytes;
  while (deadline.left() > 0 && skipped < most) {
    std::array<std::uint8_t, beginning_size> bytes{};
    const auto got = ::recv(socket, bytes.data(), bytes.size(), MSG_PEEK | MSG_DONTWAIT);
    if (got == 0 && skipped > 0) break;
    if (got == 0 || (got < 0 && errno != EAGAIN && errno != EINTR)) return {};  // whoever receives sees it
    const auto size = static_cast<std::size_t>(std::max<ssize_t>(got, 0));
    if (const std::size_t first = size_before_reply({bytes.data(), size}, to, asked); first > 0) {
      ::recv(socket, bytes.data(), first, MSG_DONTWAIT);
      if (first_bytes.size() < beginning_size)
        first_bytes.insert(first_bytes.end(), bytes.begin(), &bytes[first]);
      skipped += first;
      discarded += first;
      continue;
    }
    if (size == bytes.size() || begins_reply({bytes.data(), size}, to)) return {};
    if (!await_more(socket, size > 0, deadline)) return {};
  }
  if (skipped == 0) return {};
  return fail(BadFrame{fmt::format("{} bytes have come, and none of them begins a reply: {}", skipped,
                                   shown_bytes({first_bytes.data(), first_bytes.size()}))});
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
