// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "coupler/device/core/time.hpp"
#include "coupler/map/security.hpp"
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

/// The changes that a client with limited rights was told. It counts only those that the client may read.
struct Heard {
  bool has_begun = false;
  std::uint64_t upto = 0;    ///< number of the last change of the node that was looked at for it
  std::uint64_t number = 0;  ///< of the last one that it heard, as it counts
};

/// The state that the node keeps for a connection, from when it is opened.
struct ClientSession {
  bool is_plain = true;        ///< without TLS: its rights are those of Security::plain
  const Role* role = nullptr;  ///< of one with TLS; nullptr: none, so it has no rights
  bool has_written = false;    ///< a write of it to an output was carried out
  std::optional<Wait> wait{};  ///< nullopt: it waits for nothing
  Heard heard{};
};

}  // namespace coupler::device
