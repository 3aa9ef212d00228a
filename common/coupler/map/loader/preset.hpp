// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "coupler/map/loader/draft_point.hpp"
#include "coupler/map/loader/preset_watchdog.hpp"
#include "coupler/map/loader/presets.hpp"
#include "coupler/map/loader/reader.hpp"

namespace coupler::loader {

/// What is true of every coupler of a kind (config/presets/README.md).
struct Preset {
  struct Area {
    Table table;
    modbus::Range range;
  };
  struct ReadBack {
    Area from;
    std::uint16_t offset;
  };

  std::string_view name;
  Entry map;  ///< keys that hold unless the map has them
  std::vector<Area> areas;
  std::vector<ReadBack> read_back;
  PresetWatchdog watchdog;
};

/// The error says what is wrong with the file.
tl::expected<Preset, std::string> parse_preset(const PresetFile& file);

/// `preset:` of the map; nothing if it has none, or no known one.
std::optional<Preset> read_preset(const Entry& root, Context& context);

/// The map with the preset's keys where it has none of its own, in `limits` and `defaults` key by key.
Entry completed(Entry root, const Preset& preset);

/// Where outputs read back, and a warning for each point where the coupler has nothing.
void apply(const Preset& preset, DraftPoints& points, Context& context);

}  // namespace coupler::loader
