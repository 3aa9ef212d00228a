// SPDX-License-Identifier: Apache-2.0
// Requests and replies that libmodbus cannot frame, or whose two halves it cannot part.
#pragma once

#include <chrono>

#include "coupler/host/core/error.hpp"
#include "coupler/host/modbus/deadline.hpp"
#include "coupler/modbus/frame.hpp"

namespace coupler::host {

/// BadFrame unless `reply` has the transaction and the unit of `request`.
Result<> check_header(const modbus::Frame& reply, const modbus::Frame& request);

/// Sends `pdu` with the header `to` on a connected, non-blocking socket. It never waits: what does not go out
/// at once is an error.
Result<> send_request(int socket, const modbus::Frame& to, modbus::Bytes pdu);

/// Awaits the one reply that has this transaction and unit. Its PDU is valid as long as the framer.
Result<modbus::Bytes> receive_reply(int socket, const modbus::Frame& to, std::chrono::milliseconds timeout,
                                    const Deadline& deadline, modbus::Framer& framer);

}  // namespace coupler::host
