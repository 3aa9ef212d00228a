// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/modbus/modbus_transport.hpp"

#include <modbus/modbus.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include <fmt/format.h>

#include "coupler/host/modbus/open_socket.hpp"
#include "coupler/host/modbus/raw_exchange.hpp"

namespace coupler::host {
namespace {

Error receive_error(int error, std::chrono::milliseconds timeout) {
  switch (error) {
    case ETIMEDOUT: return Timeout{timeout};
    case EMBBADDATA: return BadFrame{"not Modbus/TCP: longer than a reply can be"};
    case ECONNRESET: return closed_instead_of_reply();  // libmodbus says so of both ways to end
    default: return TransportFailure{modbus_strerror(error)};
  }
}

/// A babbler is not listened to for ever.
constexpr int most_unasked_pieces = 64;

/// The size of the ADU by its header; 0: there is none.
std::size_t size_in_header(Span<const std::uint8_t> adu) {
  const std::size_t size = modbus::mbap_size - 1 + modbus::get_u16(&adu[4]);
  return size > modbus::mbap_size && size <= adu.size() ? size : 0;
}

/// libmodbus waits for as many bytes as the byte count says. A frame that is whole by its header, with
/// another count, is malformed, and not late.
std::optional<BadFrame> contradiction(Span<const std::uint8_t> buffer, modbus::Bytes asked) {
  const std::size_t size = size_in_header(buffer);
  if (size <= modbus::mbap_size + 1 || buffer[7] != asked[0]) return std::nullopt;
  const std::size_t count = buffer[8];
  if (size == modbus::mbap_size + 2 + count) return std::nullopt;
  return bad_reply(fmt::format("the byte count is {}, where the header leaves {}", count,
                               size - modbus::mbap_size - std::min<std::size_t>(size - modbus::mbap_size, 2)),
                   asked, modbus::Bytes(buffer.data(), size));
}

/// RFC 8446 5.1: what a device with TLS answers to plain Modbus, where the protocol's number would be 0.
bool is_tls_alert(Span<const std::uint8_t> adu) { return adu[0] == 0x15 && adu[1] == 3; }

bool is_exception(Span<const std::uint8_t> adu) {
  return adu.size() == modbus::mbap_size + 2 && (adu[7] & 0x80U) != 0;
}

/// libmodbus checks nothing in the header of a reply: it finds its end by the function code.
Result<> check_adu(Span<const std::uint8_t> adu, const modbus::Frame& request) {
  if (adu.size() <= modbus::mbap_size || modbus::get_u16(&adu[2]) != 0)
    return fail(BadFrame{"not Modbus/TCP: " + shown_bytes(adu)});
  const std::size_t told = modbus::get_u16(&adu[4]);
  if (told != adu.size() - modbus::mbap_size + 1 && !is_exception(adu))
    return fail(BadFrame{fmt::format("its header says that {} bytes follow, not {}: {}", told,
                                     adu.size() - modbus::mbap_size + 1, shown_bytes(adu))});
  modbus::Frame header;
  header.transaction = modbus::get_u16(&adu[0]);
  header.unit = adu[6];
  return check_header(header, request);
}

}  // namespace

ModbusTransport::ModbusTransport(const Connection& connection)
    : host_(connection.address),
      port_(connection.port),
      unit_(connection.unit),
      tls_(connection.tls.present() ? std::optional(TlsTexts::of(connection.tls)) : std::nullopt),
      context_(modbus_new_tcp_pi(host_.c_str(), fmt::to_string(port_).c_str()), modbus_free) {
  // Not the numbers that everybody begins with: bytes of others must not look like a reply.
  sent_.transaction = static_cast<std::uint16_t>(std::chrono::steady_clock::now().time_since_epoch().count());
  modbus_set_byte_timeout(context_.get(), 0, 0);  // none: the response timeout holds for the whole reply
  modbus_set_error_recovery(context_.get(), MODBUS_ERROR_RECOVERY_NONE);
  ModbusTransport::select(connection.unit, connection.timeout);
}

ModbusTransport::~ModbusTransport() { ModbusTransport::close(); }

Result<> ModbusTransport::select(std::uint8_t unit, std::chrono::milliseconds timeout) {
  unit_ = unit;
  if (modbus_set_slave(context_.get(), unit_) != 0)
    return fail(NotConnected{fmt::format("unit {} is reserved; Modbus has units 0 to 247 and 255", unit_)});
  timeout_ = timeout;
  return {};
}

Result<> ModbusTransport::connect() { return open(interrupted_); }

Result<> ModbusTransport::open(const Event& interrupt) {
  close();
  if (auto selected = select(unit_, timeout_); !selected) return selected;
  const Deadline deadline(timeout_);
  auto opened = open_socket(host_, port_, timeout_, interrupt);
  if (!opened) return tl::make_unexpected(opened.error());
  if (tls_) {
    auto link = open_tls(*std::move(opened), host_, *tls_, deadline, interrupt);
    if (!link)
      return fail(NotConnected{fmt::format("{} port {}: {}", host_, port_, to_string(link.error())),
                               has_remedy(link.error())});
    link_ = *std::move(link);
    opened = link_->take_socket();
  }
  const std::lock_guard lock(socket_mutex_);
  if (link_) certificates_ = link_->certificates();
  if (interrupt.is_set()) return fail(NotConnected{"interrupted"});
  socket_ = opened->release();
  modbus_set_socket(context_.get(), socket_);
  return {};
}

void ModbusTransport::close() {
  is_untrusted_ = false;
  is_first_ = true;
  unasked_ = 0;
  wait_.reset();
  wait_answer_.reset();
  {
    const std::lock_guard lock(socket_mutex_);
    if (socket_ >= 0) modbus_close(context_.get());
    socket_ = -1;
  }
  link_ = nullptr;
}

tl::unexpected<Error> ModbusTransport::failed(Error error) const {
  if (link_ && std::holds_alternative<TransportFailure>(error))
    if (std::string problem = link_->problem(); !problem.empty())
      return fail(TransportFailure{std::move(problem), true});
  return tl::unexpected<Error>(std::move(error));
}

std::optional<Certificates> ModbusTransport::certificates() const {
  const std::lock_guard lock(socket_mutex_);
  return certificates_;
}

void ModbusTransport::interrupt() {
  interrupted_.set();
  hang_up();
}

void ModbusTransport::hang_up() {
  const std::lock_guard lock(socket_mutex_);
  if (socket_ >= 0) ::shutdown(socket_, SHUT_RDWR);
}

Result<> ModbusTransport::make_ready() {
  if (socket_ < 0) return fail(NotConnected{"not connected"});
  if (wait_) return {};  // its answer may be there
  if (is_untrusted_) return open(interrupted_);
  return discard_unasked();
}

void ModbusTransport::throw_away(std::uint64_t bytes) {
  unasked_ += bytes;
  discarded_ += bytes;
}

Result<> ModbusTransport::discard_unasked() {
  std::array<std::uint8_t, modbus::max_adu_size> bytes{};
  for (int piece = 0; piece < most_unasked_pieces; ++piece) {
    const auto got = ::recv(socket_, bytes.data(), bytes.size(), MSG_DONTWAIT);
    if (got == 0) return failed(TransportFailure{"the device closed the connection"});
    if (got < 0 && (errno == EAGAIN || errno == EINTR)) return {};
    if (got < 0) return failed(TransportFailure{std::strerror(errno)});
    throw_away(static_cast<std::uint64_t>(got));
  }
  return fail(BadFrame{"bytes come without end, and nothing was asked"});
}

Result<modbus::Bytes> ModbusTransport::ask(const modbus::ReadRequest& request) {
  if (auto ready = make_ready(); !ready) return tl::make_unexpected(ready.error());
  const Deadline deadline(timeout_);
  if (auto sent = send_request(socket_, next_header(), request.pdu()); !sent) return failed(sent.error());
  if (auto before = receive_wait_before(deadline); !before) return failed(before.error());
  if (!wait_ && (is_first_ || unasked_ > 0)) {
    std::uint64_t skipped = 0;
    const auto begun = skip_to_reply(socket_, sent_, request.function(), deadline, skipped);
    throw_away(skipped);
    if (!begun) return failed(begun.error());
  }
  const int left = std::max(deadline.left(), 1);  // libmodbus takes no 0
  modbus_set_response_timeout(context_.get(), static_cast<std::uint32_t>(left / 1000),
                              static_cast<std::uint32_t>(left % 1000 * 1000));
  std::fill_n(reply_.begin(), modbus::mbap_size + 2, std::uint8_t{0});
  const int size = modbus_receive_confirmation(context_.get(), reply_.data());
  if (size < 0 && is_tls_alert(reply_))
    return fail(
        NotConnected{"the device speaks TLS at this port; reach it by tls:// (docs/security.md)", true});
  if (size < 0) {
    const int error = errno;
    if (auto wrong = error == ETIMEDOUT ? contradiction(reply_, request.pdu()) : std::nullopt)
      return fail(*std::move(wrong));
    return failed(receive_error(error, timeout_));
  }
  const Span<const std::uint8_t> adu(reply_.data(), static_cast<std::size_t>(size));
  if (auto ours = check_adu(adu, sent_); !ours) return tl::make_unexpected(ours.error());
  if (deadline.has_passed()) return fail(Timeout{timeout_});
  is_first_ = false;
  is_untrusted_ = size_in_header(adu) != adu.size();
  return modbus::Bytes(adu.data() + modbus::mbap_size, adu.size() - modbus::mbap_size);
}

modbus::Frame ModbusTransport::next_header() {
  ++sent_.transaction;
  sent_.unit = unit_;
  return sent_;
}

Result<> ModbusTransport::send_pdu(modbus::Bytes pdu) {
  if (auto ready = make_ready(); !ready) return ready;
  answer_by_ = Deadline(timeout_);
  function_ = pdu[0];
  return send_request(socket_, next_header(), pdu);
}

Result<modbus::Bytes> ModbusTransport::receive_pdu() {
  if (auto before = receive_wait_before(answer_by_); !before) return failed(before.error());
  modbus::Framer framer;
  const auto reply = receive_reply(socket_, sent_, timeout_, answer_by_, framer);
  if (const auto exception = take_lying_exception(framer, reply); !exception.empty()) return exception;
  if (!reply) return failed(reply.error());
  std::copy(reply->begin(), reply->end(), reply_.begin());
  return modbus::Bytes(reply_.data(), reply->size());
}

Result<modbus::ScheduleReply> ModbusTransport::schedule(const modbus::ScheduleRequest& request) {
  const auto reply = exchange(request.pdu());
  if (!reply) return tl::make_unexpected(reply.error());
  const auto parsed = modbus::parse_schedule_reply(*reply);
  if (parsed) return *parsed;
  if (parsed.error().exception) return fail(ExceptionReply{*parsed.error().exception});
  return fail(BadFrame{"not the reply to a request to schedule"});
}

/// The header says that there is one byte more, which comes or does not.
modbus::Bytes ModbusTransport::take_lying_exception(const modbus::Framer& framer,
                                                    const Result<modbus::Bytes>& reply) {
  constexpr std::size_t pdu_size = 2;
  const modbus::Bytes part = framer.rest();
  if (reply && reply->size() == pdu_size + 1)
    std::copy_n(reply->begin(), pdu_size, reply_.begin());
  else if (!reply && std::holds_alternative<Timeout>(reply.error()) &&
           part.size() == modbus::mbap_size + pdu_size && modbus::get_u16(&part[0]) == sent_.transaction &&
           part[6] == sent_.unit)
    std::copy_n(part.begin() + modbus::mbap_size, pdu_size, reply_.begin());
  else
    return {};
  if (reply_[0] != (function_ | 0x80U)) return {};
  is_untrusted_ = true;
  return {reply_.data(), pdu_size};
}

Result<> ModbusTransport::send_wait(const modbus::ChangesRequest& request) {
  if (auto ready = make_ready(); !ready) return ready;
  std::array<std::uint8_t, modbus::changes_request_size> pdu{};
  modbus::build_changes_request(request, pdu);
  wait_ = {next_header(), std::chrono::steady_clock::now(),
           Deadline(std::chrono::milliseconds(request.wait) + timeout_)};
  return send_request(socket_, wait_->header, pdu);
}

Result<> ModbusTransport::receive_wait() {
  if (!wait_) return fail(NotConnected{"nothing was asked for"});
  modbus::Framer framer;
  return take_wait_reply(receive_reply(socket_, wait_->header, timeout_, wait_->answer_by, framer, true));
}

Result<> ModbusTransport::receive_wait_before(const Deadline& deadline) {
  if (!wait_) return {};
  modbus::Framer framer;
  return take_wait_reply(receive_first_reply(socket_, wait_->header, timeout_, deadline, framer));
}

Result<> ModbusTransport::take_wait_reply(const Result<modbus::Bytes>& pdu) {
  if (!pdu) return failed(pdu.error());
  const auto reply = modbus::parse_changes_reply(*pdu);
  if (!reply && !reply.error().exception) return fail(BadFrame{"not the reply to a wait for changes"});
  wait_answer_ = {reply ? Result<modbus::ChangesReply>(*reply)
                        : Result<modbus::ChangesReply>(fail(ExceptionReply{*reply.error().exception})),
                  wait_->sent, std::chrono::steady_clock::now()};
  wait_.reset();
  return {};
}

Transport::Woken ModbusTransport::wait_until(Time time) {
  return wait_for(wakeup_, interrupted_, socket_, time);
}

}  // namespace coupler::host
