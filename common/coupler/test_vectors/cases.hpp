// SPDX-License-Identifier: Apache-2.0
// Values of a point and their registers or bits: what both sides of a coupler must agree on.
#pragma once

#include <cstdint>
#include <vector>

#include "coupler/codec/value.hpp"
#include "coupler/map/point.hpp"

namespace coupler::test_vectors {

struct Case {
  /// range(point).count() of them: registers as on the wire, the bits of other points zero, or bits as 0
  /// or 1.
  std::vector<std::uint16_t> raw;
  /// point.count of them; in the point's units, as double, if it has a scale.
  std::vector<codec::Value> values;
  /// Writing the values gives other registers, or is refused: NaN and infinities, a text with something
  /// behind its end.
  bool only_read = false;
};

struct Cases {
  std::vector<Case> cases;
  /// One element each: values that the point cannot hold, so that writing one is refused.
  std::vector<codec::Value> refused;
};

/// The same on every machine: zero, one, the ends of the type, negative values, patterns that show where each
/// byte stands; for floats also subnormal values, infinities and NaN; for texts the empty one, full ones and
/// characters beyond ASCII. The elements of an array differ.
Cases cases_of(const Point& point);

/// One element at `registers`; a double if the point has a scale.
codec::Value decode(const Point& point, const std::uint16_t* registers);

/// Writes one element, and leaves other bits of a shared register alone. False: the point cannot hold the
/// value, and nothing was written.
bool encode(const codec::Value& value, const Point& point, std::uint16_t* registers);

}  // namespace coupler::test_vectors
