// SPDX-License-Identifier: Apache-2.0
// Messages between processes of one node, with a descriptor beside them or without.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <initializer_list>
#include <optional>

#include "coupler/base/descriptor.hpp"
#include "coupler/base/span.hpp"

namespace coupler::device {

/// Both ends of a connected Unix socket that keeps messages apart. Each is closed on exec().
struct Channel {
  Descriptor one;
  Descriptor other;
};

/// nullopt: errno says why there is none.
std::optional<Channel> open_channel();

enum class Waits { no, until_it_is_taken };

/// The parts as one message, and `descriptor` beside it (-1: none), which both processes have then. False:
/// it was not taken.
bool send_message(int socket, std::initializer_list<Span<const std::uint8_t>> parts, int descriptor,
                  Waits waits);

/// The size of the next message, which is written to `room`; what does not fit in is lost. 0: the other end
/// is closed. -1: there is none now, or an error, which comes once. Never waits.
ssize_t receive_message(int socket, Span<std::uint8_t> room, Descriptor& descriptor);

}  // namespace coupler::device
