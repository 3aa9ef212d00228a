// SPDX-License-Identifier: Apache-2.0
// What tests of inputs that are watched share.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <tuple>
#include <utility>
#include <vector>

#include "coupler/device/gpio/line_group.hpp"

namespace coupler::device {

/// A line, its level and since when.
using Told = std::tuple<std::size_t, bool, TimePoint>;

inline TimePoint at(int ms) { return TimePoint(std::chrono::hours(1)) + std::chrono::milliseconds(ms); }

/// Remembers what it is told.
struct LineNews : LineSink {
  void edges(std::size_t line, const Edges& edges) override { counted.emplace_back(line, edges.rising); }
  void changed(std::size_t line, bool level, TimePoint when) override { all.emplace_back(line, level, when); }
  void lost(std::uint32_t count) override { lost_changes += count; }
  std::vector<Told> all;
  std::vector<std::pair<std::size_t, std::uint32_t>> counted;
  std::uint32_t lost_changes = 0;
};

}  // namespace coupler::device
