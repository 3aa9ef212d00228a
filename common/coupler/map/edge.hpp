// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

#include "coupler/base/enumeration.hpp"

namespace coupler {

enum class Edge : std::uint8_t { rising, falling, both };
constexpr Enumeration<Edge, 3> enumeration(Edge) {
  return {"Edge", {{Edge::rising, "rising"}, {Edge::falling, "falling"}, {Edge::both, "both"}}};
}

/// The edges of a discrete input.
struct EdgeOf {
  std::string_view input;  ///< the point's name
  Edge edge = Edge::rising;

  constexpr bool present() const { return !input.empty(); }
};

}  // namespace coupler
