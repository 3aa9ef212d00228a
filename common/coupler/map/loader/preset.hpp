// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <tl/expected.hpp>

#include "coupler/base/span.hpp"
#include "coupler/map/loader/draft_point.hpp"
#include "coupler/map/loader/reader.hpp"
#include "coupler/map/watchdog.hpp"

namespace coupler::loader {

/// A file of config/presets, built in.
struct PresetFile {
  std::string_view name;
  std::string_view text;
};
Span<const PresetFile> preset_files();

/// The part of a preset about the coupler's own watchdog (config/presets/README.md). The map has the rest.
struct PresetWatchdog {
  struct Write {
    WatchdogSequences::Write write;     ///< as far as it is known
    bool at_heartbeat = false;          ///< the map says where
    std::chrono::microseconds unit{0};  ///< not 0: the value is the map's timeout, counted in this
  };

  bool none = false;  ///< the coupler has none
  std::vector<Write> arm;
  std::vector<Write> feed;
  std::vector<Write> reset;
  std::optional<modbus::Exception> refusal;
  std::optional<WatchdogSequences::Write> alarm;
};

/// `watchdog:` of a preset file. The error is the place of what makes no sense.
tl::expected<PresetWatchdog, Position> parse_preset_watchdog(const Entry& entry);

/// An address or the value of a register, in a preset file; nullopt: it is neither, or not there.
std::optional<std::uint16_t> word(const Entry& entry);
std::optional<std::uint16_t> word(const Entry& entry, std::string_view key);

/// The properties of every coupler of a kind (config/presets/README.md).
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
  std::vector<std::string> models;  ///< parts of the model numbers of this kind
  Entry map;                        ///< keys that hold unless the map has them
  std::vector<Area> areas;
  std::vector<ReadBack> read_back;
  PresetWatchdog watchdog;
};

/// The error says what is wrong with the file.
tl::expected<Preset, std::string> parse_preset(const PresetFile& file);

/// Returns the name of the preset for a model number such as "750-352"; empty if there is none.
std::string_view preset_of_model(std::string_view model);

/// `preset:` of the map; nothing if it has none, or no known one.
std::optional<Preset> read_preset(const Entry& root, const Context& context);

/// The map with the preset's keys where it has none of its own, in `limits` and `defaults` key by key.
/// Without `serial`.
Entry completed(Entry root, const Preset& preset);

/// Sets where outputs read back, and warns of each point for which the coupler has no such place.
void apply(const Preset& preset, DraftPoints& points, const Context& context);

}  // namespace coupler::loader
