// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

namespace coupler {

enum class Edge : std::uint8_t { rising, falling, both };

/// The edges of a discrete input.
struct EdgeOf {
  std::string_view input;  ///< the point's name
  Edge edge = Edge::rising;

  constexpr bool present() const { return !input.empty(); }
};

}  // namespace coupler
