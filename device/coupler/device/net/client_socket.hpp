// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/socket.h>

#include <optional>

namespace coupler::device {

/// The number of bytes that the kernel holds for a client that does not read.
constexpr int client_send_buffer = 16 * 1024;

/// Sets the options of a client's TCP connection: no delay, an end that is noticed, a small send buffer.
void configure_client(int socket);

/// From now on the end of a client's TCP connection is noticed within some 5 s, though nobody says a word: a
/// cable that was pulled, a machine without power.
void notice_end_soon(int socket);

/// Returns the address at the other end of a client's socket; nullopt if the client has left.
std::optional<sockaddr_storage> peer_of(int socket);

}  // namespace coupler::device
