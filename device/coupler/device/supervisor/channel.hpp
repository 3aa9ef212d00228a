// SPDX-License-Identifier: Apache-2.0
// What a supervisor and its worker process say to each other: messages on a socket pair of their own.
#pragma once

#include <optional>
#include <variant>

#include "coupler/device/net/open_connection.hpp"

namespace coupler::device::channel {

struct Beat {};
struct MakeRoom {};
struct Ended {};    ///< the other process has ended
struct Nothing {};  ///< for now
using Message = std::variant<Beat, MakeRoom, OpenConnection, Ended, Nothing>;

/// A connected pair; the error is an errno.
struct Pair {
  Descriptor one;
  Descriptor other;
};
std::optional<Pair> open();

/// Without waiting: a message that finds no room is lost.
void send(int socket, Beat);
void send(int socket, MakeRoom);
/// Waits until there is room. The other process has the connection, too.
void send(int socket, const OpenConnection& client);

/// Without waiting.
Message receive(int socket);

}  // namespace coupler::device::channel
