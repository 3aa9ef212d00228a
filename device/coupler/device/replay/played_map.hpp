// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "coupler/device/replay/recording.hpp"

namespace coupler::device {

/// The map of a recording as a node serves it: nothing is behind its points but the recording, and they begin
/// with its first values. What a client of a foreign coupler asks for besides its points is there as well:
/// where outputs read back, and the registers of the coupler's watchdog, which do nothing.
struct PlayedMap {
  MapPtr owner;
  Map map;                                           ///< views it; its fingerprint is the recording's
  std::vector<std::uint32_t> index;                  ///< by point of the recording's map: in this one
  std::vector<std::optional<std::uint32_t>> mirror;  ///< where the same reads back, by the same
};

/// The recording outlives it.
PlayedMap map_to_play(const Recording& recording);

}  // namespace coupler::device
