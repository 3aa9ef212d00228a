// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/modbus/tcp_framer.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "coupler/modbus/frame.hpp"

namespace coupler::host {
namespace {

using modbus::at_length;
using modbus::at_protocol;
using modbus::at_unit;
constexpr std::size_t at_function = 7;
constexpr std::size_t at_count = 8;          ///< of a reply to a read; of an exception: its code
constexpr std::size_t exception_length = 3;  ///< the unit, the function code and that of the exception
constexpr std::size_t exception_size = at_unit + exception_length;

/// The limit for a device that sends noise without end.
constexpr std::uint64_t most_skipped = 16384;

bool is_read(std::uint8_t function) { return function >= 1 && function <= 4; }

/// A device with TLS answers plain Modbus with an alert (RFC 8446 5.1) and its version, 3. A Modbus header
/// has a protocol of 0 there.
constexpr std::uint16_t tls_alert = 0x1503;
bool is_tls_alert(modbus::Bytes adu) {
  return modbus::get_u16(adu.data()) == tls_alert && adu[at_protocol] == 3;
}

/// Bytes with the right transaction are the reply, even if the rest is wrong, so that the error can say what
/// is wrong. The same is true of a TLS alert.
bool begins_reply(modbus::Bytes bytes, const TcpRequest& request) {
  if (bytes.size() < 2) return false;
  const std::uint16_t begin = modbus::get_u16(bytes.data());
  return begin == tls_alert || (request.has_transaction() && begin == request.transaction());
}

/// Returns whether `bytes` may be the beginning of a reply to this request, or to another request with the
/// same function code.
bool may_begin_reply(modbus::Bytes bytes, const TcpRequest& request) {
  if (begins_reply(bytes, request)) return true;
  for (std::size_t i = at_protocol; i < std::min(bytes.size(), at_length + 1); ++i)
    if (bytes[i] != 0) return false;
  if (bytes.size() > at_unit && bytes[at_unit] != request.unit()) return false;
  if (bytes.size() <= at_function) return true;
  const std::size_t length = bytes[at_length + 1];
  const std::uint8_t function = bytes[at_function];
  if (function == (request.function() | modbus::exception_bit)) return length == exception_length;
  if (function != request.function()) return false;
  return !is_read(function) || bytes.size() <= at_count || length == at_count + 1 - at_unit + bytes[at_count];
}

/// After such an exception the unit's own reply may come.
bool may_be_followed(modbus::Bytes exception) {
  return exception.size() > at_count &&
         is_unit_away(ExceptionReply{static_cast<modbus::Exception>(exception[at_count])});
}

/// A gateway may hand the late replies to so many requests of a connection to the next one.
constexpr int most_late_replies = 16;

/// `is_first`: no reply has come over this connection, and none is late.
std::optional<BadFrame> mismatch(modbus::Bytes adu, const TcpRequest& request, bool is_first) {
  const std::uint16_t transaction = modbus::get_u16(adu.data());
  if (request.has_transaction() && transaction != request.transaction()) {
    std::string what = fmt::format("the reply to another request: transaction {}, where {} was asked",
                                   transaction, request.transaction());
    const auto before = static_cast<std::uint16_t>(request.transaction() - transaction);
    if (!is_first || before <= most_late_replies) return BadFrame{std::move(what)};
    return BadFrame{
        what +
            ". It is the first reply over this connection, so it is not a late one. If the device "
            "does not repeat transaction ids, set `limits: {transaction_ids: false}` in the map",
        true};
  }
  const unsigned unit = adu[at_unit];
  if (unit == request.unit()) return std::nullopt;
  std::string what = fmt::format("unit {} answered a request to unit {}", unit, request.unit());
  if (!request.has_transaction() && !is_first) return BadFrame{std::move(what)};  // for another client
  if (unit == 0)
    return BadFrame{what +
                    "; if the device takes requests to unit 0, set `unit: 0`; otherwise ask its maker for a "
                    "gateway that repeats the unit id"};
  return BadFrame{fmt::format("{}; if the device is unit {}, set `unit: {}`", what, unit, unit)};
}

}  // namespace

void TcpRequest::set(std::optional<std::uint16_t> transaction, std::uint8_t unit, modbus::Bytes pdu) {
  has_transaction_ = transaction.has_value();
  modbus::put_header({transaction.value_or(0), unit, {}}, pdu.size(), adu_.data());
  std::copy(pdu.begin(), pdu.end(), adu_.begin() + modbus::mbap_size);
  size_ = modbus::mbap_size + pdu.size();
}

void TcpFramer::reset() {
  buffer_.clear();
  is_first_ = is_trusted_ = true;
  has_noise_ = false;
  given_up_ = 0;
  skipped_before_ = skipped_;
}

bool TcpFramer::skip_late_replies(const TcpRequest& request) {
  for (;;) {
    const modbus::Bytes adu = rest();
    if (given_up_ == 0 || !request.has_transaction() || adu.size() < 2) return true;
    const auto before = static_cast<std::uint16_t>(request.transaction() - modbus::get_u16(adu.data()));
    if (before == 0 || before > given_up_) return true;
    if (adu.size() <= at_unit) return false;
    const std::size_t size = modbus::adu_size(adu);
    if (size == 0) return true;
    if (adu.size() < size) return false;
    buffer_.take(size);
    skipped_ += size;
    skipped_before_ += size;  // it is no noise
  }
}

TcpFramer::Outcome TcpFramer::next(const TcpRequest& request) {
  if (!skip_late_replies(request)) return Outcome::nothing;
  // Bytes before the answer to a wait can be the reply to the request that was sent after the wait.
  const bool is_wait = request.function() == static_cast<std::uint8_t>(modbus::Function::wait_for_changes);
  if (!is_wait && (is_first_ || has_noise_))
    while (!rest().empty() && !may_begin_reply(rest(), request)) skip(1);
  if (skipped_ - skipped_before_ > most_skipped)
    if (auto wrong = noise(request)) return refuse(request, *std::move(wrong));

  const modbus::Bytes adu = rest();
  if (adu.size() <= at_unit) return Outcome::nothing;
  if (is_tls_alert(adu))
    return refuse(
        request,
        NotConnected{"the device speaks TLS at this port; reach it by tls:// (docs/security.md)", true});
  const std::size_t size = modbus::adu_size(adu);
  if (size == 0) return refuse(request, BadFrame{"not Modbus/TCP: " + shown_bytes(adu)});
  if (auto wrong = mismatch(adu, request, is_first_ && given_up_ == 0))
    return refuse(request, *std::move(wrong));

  if (adu.size() <= at_function) return Outcome::nothing;
  if (adu[at_function] == (request.function() | modbus::exception_bit)) {
    if (adu.size() < std::min(size, exception_size)) return Outcome::nothing;
    is_trusted_ = size == exception_size && (request.has_transaction() || !may_be_followed(adu));
    return take(request, std::min(size, exception_size));
  }
  // If header and byte count contradict each other, the missing bytes may never come: this is an error now,
  // not a timeout later.
  if (adu[at_function] == request.function() && is_read(request.function()) && size > at_count) {
    if (adu.size() <= at_count) return Outcome::nothing;
    const std::size_t left = size - at_count - 1;
    if (adu[at_count] != left)
      return refuse(request, bad_reply(fmt::format("the byte count is {}, where the header leaves {}",
                                                   adu[at_count], left),
                                       request.pdu(), adu.first(std::min(adu.size(), size))));
  }
  return adu.size() < size ? Outcome::nothing : take(request, size);
}

TcpFramer::Outcome TcpFramer::take(const TcpRequest& request, std::size_t bytes) {
  pdu_ = rest().first(bytes).from(modbus::mbap_size);
  buffer_.take(bytes);
  if (!request.has_transaction() && !rest().empty()) is_trusted_ = false;  // one of the two was another's
  is_first_ = false;
  given_up_ = 0;
  return Outcome::reply;
}

TcpFramer::Outcome TcpFramer::refuse(const TcpRequest& request, Error problem) {
  problem_ = std::move(problem);
  give_up(request);
  return Outcome::bad;
}

void TcpFramer::skip(std::size_t bytes) {
  for (const std::uint8_t byte : rest().first(bytes)) {
    const std::uint64_t since_drop = skipped_++ - skipped_before_;
    if (since_drop < first_skipped_.size()) first_skipped_[since_drop] = byte;
  }
  buffer_.take(bytes);
  has_noise_ = has_noise_ || bytes > 0;
}

void TcpFramer::drop() {
  skip(rest().size());
  skipped_before_ = skipped_;
}

std::optional<BadFrame> TcpFramer::noise(const TcpRequest& request) const {
  const std::uint64_t skipped = skipped_ - skipped_before_;
  const bool begins = request.has_transaction()
                          ? begins_reply(rest(), request)
                          : rest().size() > at_function && may_begin_reply(rest(), request);
  if (skipped == 0 || begins) return std::nullopt;
  const auto shown = std::min<std::uint64_t>(skipped, first_skipped_.size());
  return BadFrame{fmt::format("{} bytes have come, and none of them begins a reply: {}",
                              skipped + rest().size(),
                              shown_bytes({first_skipped_.data(), static_cast<std::size_t>(shown)}))};
}

}  // namespace coupler::host
