// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <tuple>

#include "coupler/map/point.hpp"

namespace coupler {

/// Returns whether a value of one point means the same in the other, wherever they stand in their tables.
inline bool same_value(const Point& a, const Point& b) {
  const auto layout = [](const Point& p) {
    const codec::Format& f = p.format;
    return std::tuple(p.table, p.count, f.type, f.order, f.bit, f.bits, f.half, f.length, f.encoding,
                      p.scale.gain, p.scale.offset, p.scale.exponent_of);
  };
  return layout(a) == layout(b);
}

}  // namespace coupler
