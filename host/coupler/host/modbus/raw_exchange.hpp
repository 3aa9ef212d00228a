// SPDX-License-Identifier: Apache-2.0
// Sending a request and receiving its reply without libmodbus, which does not know all functions and cannot
// send and receive in separate calls.
#pragma once

#include <chrono>

#include "coupler/host/core/error.hpp"
#include "coupler/host/modbus/wait.hpp"
#include "coupler/modbus/frame.hpp"

namespace coupler::host {

/// BadFrame unless `reply` has the transaction and the unit of `request`.
Result<> check_header(const modbus::Frame& reply, const modbus::Frame& request);

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
