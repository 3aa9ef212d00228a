// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include <tl/expected.hpp>

#include "coupler/modbus/pdu.hpp"

namespace coupler::host {

/// There is no connection, and none could be made.
struct NotConnected {
  std::string why;
  bool has_remedy = false;  ///< `why` says what to do
};
/// The connection broke.
struct TransportFailure {
  std::string why;
  bool has_remedy = false;           ///< `why` says what to do
  bool is_instead_of_reply = false;  ///< it came after a request, which the device may refuse in this way
};
/// No complete reply within the device's timeout.
struct Timeout {
  std::chrono::milliseconds after;
};
/// The device refuses the request. Any code may arrive (MAP 7).
struct ExceptionReply {
  modbus::Exception code;
  /// Set if there is no code: the device acknowledges a write, but with this value instead of the one that
  /// was sent.
  std::optional<std::uint16_t> other_value{};
};
/// A reply that is not an answer to the request.
struct BadFrame {
  std::string why;
  bool has_remedy = false;  ///< `why` says what to do
};

/// How a request can fail.
using Error = std::variant<NotConnected, TransportFailure, Timeout, ExceptionReply, BadFrame>;

template <class T = void>
using Result = tl::expected<T, Error>;

template <class E>
tl::unexpected<Error> fail(E error) {
  return tl::unexpected<Error>(Error(std::move(error)));
}

/// Returns the exception if the error is one. Every other error ends the connection, since a late reply must
/// never be taken for the reply to the next request.
const ExceptionReply* exception_in(const Error& error);

/// Returns whether a node refuses this client the right to the request (exception 01; a node knows every
/// function).
bool is_no_right(const Error& error);

/// Returns whether a gateway says that it cannot reach the unit behind it (exceptions 0A and 0B).
bool is_unit_away(const Error& error);

/// Returns whether the unit itself refuses the request, by any other exception.
bool is_unit_refusal(const Error& error);

/// Returns whether there was no reply, the end of the connection instead of one, or a malformed one: the
/// device may be gone, or may refuse this request in this way.
bool is_no_reply(const Error& error);

/// Returns whether the device ended the connection instead of replying.
bool is_closed(const Error& error);

/// Returns whether the text of the error says what to do, so that no general advice need follow.
bool has_remedy(const Error& error);

/// Returns a text as "exception 02 (illegal data address)" or "no reply within 3000 ms".
std::string to_string(const Error& error);

/// Shows at most sixteen bytes, as in "03 04 00 14".
std::string shown_bytes(modbus::Bytes bytes);

/// Makes an error that shows the request and the reply: `asked` and `came` are two PDUs, or two ADUs.
BadFrame bad_reply(std::string_view what, modbus::Bytes asked, modbus::Bytes came);

/// Makes the error for the PDU `came`, which does not answer the PDU `asked` as it should.
Error error_of(const modbus::ReplyError& why, modbus::Bytes asked, modbus::Bytes came);

}  // namespace coupler::host
