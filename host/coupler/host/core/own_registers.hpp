// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "coupler/base/span.hpp"
#include "coupler/map/point.hpp"
#include "coupler/plan/read_span.hpp"

namespace coupler::host {

/// Takes the values of one of the points out of a reply, as Sink receives it: each element of `own` is an
/// element of `values` without the bits of other points.
template <class Element>
void take_own(const plan::ReadSpan& span, Span<const Element> values, const Point& point,
              std::vector<std::uint16_t>& own) {
  const modbus::Range range = read_range(point);
  const Element* const from = values.data() + (range.start() - span.range.start());
  const std::uint16_t mask = own_bits(point);
  own.assign(from, from + range.count());
  for (std::uint16_t& each : own) each = static_cast<std::uint16_t>(each & mask);
}

}  // namespace coupler::host
