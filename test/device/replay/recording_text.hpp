// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "coupler/device/replay/recording.hpp"
#include "coupler/map/loader/load.hpp"

namespace coupler::device {

/// So long since the beginning, at 2026-11-21T13:20:11.123Z.
inline record::Moment played_at(double seconds) {
  return {std::chrono::round<Nanoseconds>(std::chrono::duration<double>(seconds)),
          std::chrono::milliseconds(1795267211123)};
}

/// Points: lamp, a coil; level and speed, holding registers; row, two coils; temperature, a REAL.
inline const std::string played_map =
    "name: press\n"
    "mapping:\n"
    "  coils: {lamp: 0, row: {address: 8, count: 2}}\n"
    "  holding_registers:\n"
    "    level: {address: 0, type: INT}\n"
    "    speed: {address: 1, type: INT}\n"
    "  input_registers:\n"
    "    temperature: {address: 0, type: REAL}\n";

inline record::Head played_head(const std::string& map = played_map) {
  return {"press", "10.0.0.1:502", "0123456789abcdef", map, {{"level", 0.1}, {"lamp", 0.02}}, {}};
}

inline std::string bit_at(double seconds, const std::string& point, bool on) {
  return record::value_line(played_at(seconds), point, on ? "true" : "false", {}, {});
}
inline std::string words_at(double seconds, const std::string& point,
                            const std::vector<std::uint16_t>& words) {
  return record::value_line(played_at(seconds), point, "0", {}, words);
}

inline MapPtr map_of_text(const std::string& text) {
  const LoadResult loaded = load_map(text, "press.yaml");
  for (const Diagnostic& each : loaded.diagnostics) ADD_FAILURE() << to_string(each);
  return loaded.map;
}

/// A recording of these lines, which can be read. `map`: null is its own.
inline Recording recording_of_lines(const std::string& lines, const MapPtr& map = nullptr,
                                    const record::Head& head = played_head()) {
  std::istringstream text(record::head_line(head, played_at(0)) + lines);
  auto recording = Recording::read(text, "press.jsonl", map);
  EXPECT_TRUE(recording.has_value()) << recording.error();
  return *std::move(recording);
}

inline std::uint32_t played_index(const Recording& recording, std::string_view name) {
  const Map& map = recording.map()->map();
  return static_cast<std::uint32_t>(find(map, name) - map.points.begin());
}

}  // namespace coupler::device
