// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include <tl/expected.hpp>

#include "coupler/map/loader/entry.hpp"
#include "coupler/map/watchdog_sequences.hpp"

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

// What elements of a preset file consist of. nullptr, nullopt: there is no such thing.
const Entry* child(const Entry& entry, std::string_view key);
/// An address or the value of a register.
std::optional<std::uint16_t> word(const Entry& entry);
std::optional<std::uint16_t> word(const Entry& entry, std::string_view key);

}  // namespace coupler::loader
