// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "coupler/map/table.hpp"
#include "coupler/modbus/range.hpp"

namespace coupler::plan {

/// Why a request ends where it does.
struct Cut {
  enum class Reason : std::uint8_t {
    end_of_table,  ///< no further point is to be read
    other_rate,    ///< what follows is read at another rate
    unreadable,    ///< addresses that must not be read lie in between, or the device refused to read across
    write_only,    ///< a point that can only be written lies in between
    unmapped,      ///< unmapped addresses lie in between, and the map does not say that they may be read
    gap,           ///< as many addresses lie in between as the gap of the map, or more
    limit          ///< the request would be longer than the device takes
  };
  Reason reason = Reason::end_of_table;
  std::optional<std::uint32_t> next{};  ///< index of the point that is not in the request any more
  std::uint32_t between = 0;            ///< addresses between the request and `next`
};

/// What one read request covers.
struct ReadSpan {
  Table table;
  modbus::Range range;
  std::vector<std::uint32_t> points;  ///< indices into Map::points, by address; each lies inside `range`
  Cut end{};
};

}  // namespace coupler::plan
