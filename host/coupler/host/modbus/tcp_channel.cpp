// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/modbus/tcp_channel.hpp"

#include <poll.h>
#include <sys/socket.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include <fmt/format.h>

#include "coupler/base/descriptor.hpp"
#include "coupler/host/modbus/open_socket.hpp"
#include "coupler/map/serial.hpp"

namespace coupler::host {
namespace {

/// A babbler is not listened to for ever.
constexpr int most_unasked_pieces = 64;

/// Returns whether it is the id of a unit on a line behind a gateway, or of the device itself (TCP 4.4.1.2).
bool is_tcp_unit(std::uint8_t unit) { return unit == 0 || is_rtu_unit(unit) || unit == 255; }

}  // namespace

TcpChannel::TcpChannel(const Connection& connection, bool transaction_ids)
    : host_(connection.address),
      port_(connection.port),
      unit_(connection.unit),
      tls_(connection.tls.present() ? std::optional(TlsTexts::of(connection.tls)) : std::nullopt),
      timeout_(connection.timeout),
      transaction_ids_(transaction_ids),
      // The first number is not that of other programs, so that bytes for others do not look like a reply.
      transaction_(static_cast<std::uint16_t>(std::chrono::steady_clock::now().time_since_epoch().count())) {}

TcpChannel::~TcpChannel() { TcpChannel::close(); }

Result<> TcpChannel::select(std::uint8_t unit, std::chrono::milliseconds timeout) {
  unit_ = unit;
  if (!is_tcp_unit(unit_))
    return fail(NotConnected{fmt::format("unit {} is reserved; Modbus has units 0 to 247 and 255", unit_)});
  timeout_ = timeout;
  return {};
}

Result<> TcpChannel::open(const Event& interrupt) {
  close();
  if (auto selected = select(unit_, timeout_); !selected) return selected;
  const Deadline deadline(timeout_);
  auto opened = open_socket(host_, port_, timeout_, interrupt);
  if (!opened) return tl::make_unexpected(opened.error());
  if (tls_) {
    auto secured = open_tls(opened->get(), host_, *tls_, deadline, interrupt);
    if (!secured)
      return fail(NotConnected{fmt::format("{} port {}: {}", host_, port_, to_string(secured.error())),
                               has_remedy(secured.error())});
    tls_socket_ = *std::move(secured);
  }
  const std::lock_guard lock(socket_mutex_);
  if (tls_socket_) certificates_ = tls_socket_->certificates();
  socket_ = *std::move(opened);
  if (interrupt.is_set()) return fail(NotConnected{"interrupted"});
  return {};
}

void TcpChannel::close() {
  framer_.reset();
  wait_.reset();
  wait_answer_.reset();
  tls_socket_ = nullptr;
  const std::lock_guard lock(socket_mutex_);
  socket_ = Descriptor();
}

tl::unexpected<Error> TcpChannel::failed(Error error) const {
  if (tls_socket_ && std::holds_alternative<TransportFailure>(error))
    if (std::string problem = tls_socket_->problem(); !problem.empty())
      return fail(TransportFailure{std::move(problem), true});
  return tl::unexpected<Error>(std::move(error));
}

std::optional<Certificates> TcpChannel::certificates() const {
  const std::lock_guard lock(socket_mutex_);
  return certificates_;
}

void TcpChannel::hang_up() {
  const std::lock_guard lock(socket_mutex_);
  if (socket_.get() >= 0) ::shutdown(socket_.get(), SHUT_RDWR);
}

Result<> TcpChannel::make_ready() {
  if (socket_.get() < 0) return fail(NotConnected{"not connected"});
  if (wait_) return {};  // its answer may be there
  return discard_unasked();
}

Result<> TcpChannel::discard_unasked() {
  for (int piece = 0; piece < most_unasked_pieces; ++piece) {
    framer_.drop();
    const auto got = take(framer_.room());
    if (got == 0) return failed(TransportFailure{"the device closed the connection"});
    if (got < 0 && would_block()) {
      if (!tls_socket_ || !is_readable(socket_.get())) return {};
      continue;  // it was a message of TLS itself
    }
    if (got < 0) return failed(TransportFailure{std::strerror(errno)});
    framer_.filled(static_cast<std::size_t>(got));
    if (!transaction_ids_ && !framer_.is_first())
      return fail(
          BadFrame{"bytes have come that nobody asked for: without transaction ids they could be taken "
                   "for the next reply"});
  }
  return fail(BadFrame{"bytes keep coming although nothing was asked"});
}

ssize_t TcpChannel::take(Span<std::uint8_t> room) {
  return tls_socket_ ? tls_socket_->receive(room)
                     : ::recv(socket_.get(), room.data(), room.size(), MSG_DONTWAIT);
}

Woken TcpChannel::wait_until(Time time, Wakeup& wakeup, const Event& interrupted) {
  return has_pending() ? Woken::by_bytes : wait_for(wakeup, &interrupted, socket_.get(), time);
}

void TcpChannel::build(TcpRequest& request, modbus::Bytes pdu) {
  ++transaction_;
  request.set(transaction_ids_ ? std::optional(transaction_) : std::nullopt, unit_, pdu);
}

/// It never waits: what does not go out at once is an error.
Result<> TcpChannel::put(const TcpRequest& request) {
  const modbus::Bytes adu = request.adu();
  const auto sent = tls_socket_ ? tls_socket_->send(adu)
                                : ::send(socket_.get(), adu.data(), adu.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
  if (sent == static_cast<ssize_t>(adu.size())) return {};
  return failed(
      TransportFailure{sent < 0 ? std::strerror(errno) : "only a part of the request could be sent"});
}

Result<modbus::Bytes> TcpChannel::await_reply(const TcpRequest& request, Deadline deadline, bool has_come) {
  for (bool waits = !has_come && !has_pending();;) {
    const auto outcome = framer_.next(request);
    if (outcome == TcpFramer::Outcome::reply) return framer_.pdu();
    if (outcome == TcpFramer::Outcome::bad) return tl::make_unexpected(framer_.problem());
    if (waits && std::exchange(has_come, false)) deadline = std::min(deadline, Deadline(timeout_));
    pollfd wanted{socket_.get(), POLLIN, 0};
    if (waits && ::poll(&wanted, 1, deadline.left()) == 0) {
      framer_.give_up(request);
      return no_reply(request, Timeout{timeout_});
    }
    const auto got = take(framer_.room());
    waits = got <= 0;
    if (got == 0 || (got < 0 && errno == ECONNRESET))
      return no_reply(request, TransportFailure{"the device closed the connection", false, true});
    if (got > 0)
      framer_.filled(static_cast<std::size_t>(got));
    else if (!would_block())
      return no_reply(request, TransportFailure{std::strerror(errno)});
  }
}

tl::unexpected<Error> TcpChannel::no_reply(const TcpRequest& request, Error error) const {
  if (auto noise = framer_.noise(request)) return fail(*std::move(noise));
  return failed(std::move(error));
}

Result<> TcpChannel::send(modbus::Bytes pdu) {
  if (auto ready = make_ready(); !ready) return ready;
  answer_by_ = Deadline(timeout_);
  build(sent_, pdu);
  return put(sent_);
}

Result<modbus::Bytes> TcpChannel::receive() {
  if (auto before = receive_wait_before(answer_by_); !before) return tl::make_unexpected(before.error());
  return await_reply(sent_, answer_by_);
}

Result<> TcpChannel::send_wait(const modbus::ChangesRequest& request) {
  if (auto ready = make_ready(); !ready) return ready;
  std::array<std::uint8_t, modbus::changes_request_size> pdu{};
  modbus::build_changes_request(request, pdu);
  wait_ = {
      {}, std::chrono::steady_clock::now(), Deadline(std::chrono::milliseconds(request.wait) + timeout_)};
  build(wait_->request, pdu);
  return put(wait_->request);
}

Result<> TcpChannel::receive_wait() {
  if (!wait_) return fail(NotConnected{"nothing was asked for"});
  if (tls_socket_ && framer_.is_empty() && !wait_->answer_by.has_passed()) {
    const auto got = take(framer_.room());
    if (got < 0 && would_block()) return {};  // it was a message of TLS itself
    if (got > 0) framer_.filled(static_cast<std::size_t>(got));
  }
  return take_wait_reply(await_reply(wait_->request, wait_->answer_by, true));
}

Result<> TcpChannel::receive_wait_before(const Deadline& deadline) {
  if (!wait_) return {};
  return take_wait_reply(await_reply(wait_->request, deadline));
}

Result<> TcpChannel::take_wait_reply(const Result<modbus::Bytes>& pdu) {
  if (!pdu) return tl::make_unexpected(pdu.error());
  const auto reply = modbus::parse_changes_reply(*pdu);
  if (!reply && !reply.error().exception) return fail(BadFrame{"not the reply to a wait for changes"});
  wait_answer_ = {reply ? Result<modbus::ChangesReply>(*reply)
                        : Result<modbus::ChangesReply>(fail(ExceptionReply{*reply.error().exception})),
                  wait_->sent, std::chrono::steady_clock::now()};
  wait_.reset();
  return {};
}

}  // namespace coupler::host
