// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "coupler/device/net/descriptor.hpp"

namespace coupler::device {

/// A client that one process, or one map, hands over to the next.
struct OpenConnection {
  Descriptor socket;
  bool has_written = false;            ///< ClientSession's
  std::vector<std::uint8_t> unread{};  ///< received, not answered; at most an ADU
  std::vector<std::uint8_t> unsent{};  ///< replies that the client has not taken
};

}  // namespace coupler::device
