// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "coupler/device/core/time.hpp"
#include "coupler/modbus/changes.hpp"

namespace coupler::device {

/// A request to wait for changes that is not answered yet.
struct Wait {
  modbus::ChangesRequest request{};
  TimePoint arrived{};
  TimePoint until{};  ///< it is answered then at the latest
  std::uint16_t transaction = 0;
  std::uint8_t unit = 0;
};

/// What the node remembers of a connection, from when it is opened.
struct ClientSession {
  bool has_written = false;    ///< a write of it to an output was carried out
  std::optional<Wait> wait{};  ///< nullopt: it waits for nothing
};

}  // namespace coupler::device
