// SPDX-License-Identifier: Apache-2.0
// Who may read and write what of a node. Roles are those of "MODBUS/TCP Security" (MBTPS 8.3); that their
// rights are given point by point is this project's.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "coupler/base/span.hpp"

namespace coupler {

/// Bits: what can be done with a point.
enum class Right : std::uint8_t { read = 1, write = 2 };

/// What clients of one role may do.
struct Role {
  std::string_view name;
  Span<const std::uint8_t> rights{};  ///< bits of Right for each of Map::points, in their order
  bool reads_all = false;             ///< every point that can be read, and what shows all of them

  constexpr bool may(Right right, std::size_t point) const {
    return (rights[point] & static_cast<std::uint8_t>(right)) != 0;
  }
};

/// Without roles everybody may do everything.
struct Security {
  Span<const Role> roles{};
  std::optional<std::uint16_t> plain{};  ///< the role of clients without TLS; nullopt: they may do nothing

  constexpr bool present() const { return !roles.empty(); }
};

}  // namespace coupler
