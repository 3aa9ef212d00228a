// SPDX-License-Identifier: Apache-2.0
// How values stand in registers, drawn with a value of the map's own points: an example for each order of
// bytes that the map uses, and one for its bits and bytes in a register. As text and as SVG.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "coupler/map/map.hpp"

namespace coupler::docs {

/// Registers side by side, each cut into its two bytes or its sixteen bits, the high one first, as they stand
/// in a reply.
struct Drawing {
  struct Cell {
    std::string label;    ///< which byte or bit of the value it is
    std::string content;  ///< in hexadecimal, or 0 and 1
    bool is_used = true;  ///< some point has it
  };
  struct Register {
    std::uint32_t address = 0;
    std::vector<Cell> cells;
  };

  std::string title;
  std::string explanation;
  std::vector<Register> registers;
};

/// None for a map without registers, one for each order that it uses.
std::vector<Drawing> drawings_of(const Map& map);

/// Draws it as a block of text in a font of one width.
std::string as_text(const Drawing& drawing);

/// An element of an HTML page, which gives it its colours.
std::string as_svg(const Drawing& drawing);

}  // namespace coupler::docs
