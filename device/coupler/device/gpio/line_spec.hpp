// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "coupler/device/gpio/inventory.hpp"
#include "coupler/map/hardware.hpp"
#include "coupler/map/point.hpp"

namespace coupler::device {

/// A point of the map and the line behind it: a coil's is an output, a discrete input's an input.
struct LineSpec {
  const Point* point = nullptr;
  FoundLine line;
  std::optional<Edge> counted;  ///< the edges that counters and latched points want of it
  int level = 0;                ///< that an output begins with
};

inline bool is_output(const LineSpec& wanted) { return wanted.point->table == Table::coils; }

/// The level that an output begins with: the map's initial one, or its safe one if `safe`.
int first_level(const Point& point, bool safe);

/// "gpiochip0 line 5 (GPIO5), gpiochip0 line 6 (GPIO6) and 3 more".
std::string names_of(const std::vector<LineSpec>& lines);

/// Who holds a line of the chip: the consumer's name, empty if it has none; nullopt: nobody.
using HolderOf = std::function<std::optional<std::string>(unsigned offset)>;

/// Why the kernel refused to give these lines with `error` (an errno), and what to do. The kernel refuses a
/// request as a whole; whose fault it was is found line by line.
std::string refusal(const std::vector<LineSpec>& lines, int error, const HolderOf& holder_of);

}  // namespace coupler::device
