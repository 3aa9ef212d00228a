// SPDX-License-Identifier: Apache-2.0
// Sending a request and receiving its reply without libmodbus, which does not know all functions and cannot
// send and receive in separate calls.
#pragma once

#include <chrono>
#include <string>
#include <string_view>

#include "coupler/host/core/error.hpp"
#include "coupler/host/modbus/wait.hpp"
#include "coupler/modbus/frame.hpp"

namespace coupler::host {

/// "03 04 00 14 …": sixteen of them at most.
std::string shown_bytes(modbus::Bytes bytes);

/// BadFrame that says what was asked and what came, from the function code on or both as a whole.
BadFrame bad_reply(std::string_view what, modbus::Bytes asked, modbus::Bytes came);

/// Perhaps because of the request.
inline TransportFailure closed_instead_of_reply() {
  return {"the device closed the connection", false, true};
}

/// BadFrame unless `reply` has the transaction and the unit of `request`.
Result<> check_header(const modbus::Frame& reply, const modbus::Frame& request);

/// Waits until a reply begins, whose request is `asked`, and throws away what comes before it: the greeting
/// of a serial server, a heartbeat, another client's frame. Adds how much that was to `discarded`. A reply to
/// another request stays, since it tells what is wrong. BadFrame if nothing else has come until `deadline`.
Result<> skip_to_reply(int socket, const modbus::Frame& to, std::uint8_t asked, const Deadline& deadline,
                       std::uint64_t& discarded);

/// Sends `pdu` with the header `to` on a connected, non-blocking socket. It never waits: what does not go out
/// at once is an error.
Result<> send_request(int socket, const modbus::Frame& to, modbus::Bytes pdu);

/// Waits for the reply with this transaction and unit. Its PDU is valid as long as the framer.
/// `has_begun`: it has come, or a part of it, the rest of which comes within `timeout` from now.
Result<modbus::Bytes> receive_reply(int socket, const modbus::Frame& to, std::chrono::milliseconds timeout,
                                    const Deadline& deadline, modbus::Framer& framer, bool has_begun = false);

/// The same where the reply to a later request may follow: takes no byte of that one.
Result<modbus::Bytes> receive_first_reply(int socket, const modbus::Frame& to,
                                          std::chrono::milliseconds timeout, const Deadline& deadline,
                                          modbus::Framer& framer);

}  // namespace coupler::host
