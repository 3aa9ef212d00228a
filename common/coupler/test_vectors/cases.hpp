// SPDX-License-Identifier: Apache-2.0
// Values of a point and how they stand on the wire: what every side of a coupler must agree on.
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
  /// Of one element each: values that are none of the point.
  std::vector<codec::Value> refused;
};

/// The same on every machine: zero, one, the ends of the type, negative ones, patterns that show where each
/// byte stands; of floats also subnormal ones, infinities, NaN; of texts empty, full and foreign ones.
/// Arrays hold other values in each element.
Cases cases_of(const Point& point);

/// One element at `registers`; a double if the point has a scale.
codec::Value decode(const Point& point, const std::uint16_t* registers);

/// Writes one element, and leaves other bits of a shared register alone. False: it is none of the point, and
/// nothing was written.
bool encode(const codec::Value& value, const Point& point, std::uint16_t* registers);

}  // namespace coupler::test_vectors
