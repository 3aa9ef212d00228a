// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
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
  bool has_remedy = false;           ///< as above
  bool is_instead_of_reply = false;  ///< it came after the request: perhaps the device refuses that so
};
/// No complete reply within the device's timeout.
struct Timeout {
  std::chrono::milliseconds after;
};
/// The device refuses the request. Any code may arrive (MAP 7).
struct ExceptionReply {
  modbus::Exception code;
  /// There is no code: it acknowledges a write, but with this value instead of the one that was sent.
  std::optional<std::uint16_t> other_value{};
};
/// A reply that is not an answer to the request.
struct BadFrame {
  std::string why;
};

/// How a request can fail.
using Error = std::variant<NotConnected, TransportFailure, Timeout, ExceptionReply, BadFrame>;

template <class T = void>
using Result = tl::expected<T, Error>;

template <class E>
tl::unexpected<Error> fail(E error) {
  return tl::unexpected<Error>(Error(std::move(error)));
}

/// The exception code if the error is one. Every other error ends the connection: its late reply must never
/// be taken for the answer to the next request.
const ExceptionReply* exception_in(const Error& error);

/// Of a node, which knows every function: this client has no right to ask for that (exception 01).
bool is_no_right(const Error& error);

/// A gateway is there and says that the unit behind it is not (exceptions 0A and 0B).
bool is_unit_away(const Error& error);

/// No reply, the end of the connection instead, or no reply that can be one: of the device, or of this
/// request only.
bool is_no_reply(const Error& error);

/// The device ended the connection in place of a reply.
bool is_closed(const Error& error);

/// Its text says what to do: no general advice need follow.
bool has_remedy(const Error& error);

/// "exception 02 (illegal data address)", "no reply within 3000 ms" …
std::string to_string(const Error& error);

}  // namespace coupler::host
