// SPDX-License-Identifier: Apache-2.0
// What a supervisor and the process that does TLS say to each other (net/message.hpp): a byte, and what it
// says; a descriptor may be beside it. Where that process finds its end of the channel, and that on which it
// hands over clients.
#pragma once

#include <cstdint>

namespace coupler::device::tls_messages {

// From the supervisor.
constexpr std::uint8_t prepare = 'P';  ///< beside it: the memory of TlsSettings. It is answered.
constexpr std::uint8_t commit = 'C';   ///< beside it: the socket that listens. What was prepared is in force.
constexpr std::uint8_t alive = 'A';    ///< It is answered.

// To it.
constexpr std::uint8_t still_alive = 'a';
constexpr std::uint8_t prepared = 'p';
constexpr std::uint8_t refused = 'r';  ///< and why, one line

constexpr int control_descriptor = 3;
constexpr int clients_descriptor = 4;

constexpr const char* program_name = "coupler-node-tls";

}  // namespace coupler::device::tls_messages
