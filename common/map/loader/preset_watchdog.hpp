// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <tl/expected.hpp>
#include <vector>

#include "common/map/loader/entry.hpp"
#include "common/map/watchdog_sequences.hpp"

namespace coupler::loader {

/// What a preset knows of the coupler's own watchdog (config/presets/README.md); the map says the rest.
struct PresetWatchdog {
  struct Write {
    WatchdogSequences::Write write;     ///< as far as it is known
    bool at_heartbeat = false;          ///< the map says where
    std::chrono::microseconds unit{0};  ///< not 0: the value is the map's timeout, counted in this
  };

  std::vector<Write> arm;
  std::vector<Write> feed;
  std::vector<Write> reset;
  std::optional<modbus::Exception> refusal;
  std::optional<WatchdogSequences::Write> alarm;
};

/// `watchdog:` of a preset file. The error is where something of it makes no sense.
tl::expected<PresetWatchdog, Position> parse_preset_watchdog(const Entry& entry);

}  // namespace coupler::loader
