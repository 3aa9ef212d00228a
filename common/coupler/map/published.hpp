// SPDX-License-Identifier: Apache-2.0
// What the host publishes of a point with a scale whose exponent is in another register of the device.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "coupler/codec/scale.hpp"
#include "coupler/map/map.hpp"

namespace coupler {

/// The largest magnitude of an exponent. A point whose exponent is beyond it is invalid. SunSpec uses -10 to
/// 10.
constexpr int most_exponent = 30;

/// A point, and the one that holds the exponent of its scale: indices into Map::points.
struct ScaledPoint {
  std::uint32_t point;
  std::uint32_t exponent;
};
/// Returns the points whose scale has an exponent, in the map's order.
std::vector<ScaledPoint> points_with_exponent(const Map& map);

/// The number of registers that a value of the point has in the host: those of read_range(point), and behind
/// them the exponent, a std::int16_t, if the scale has one.
constexpr std::size_t host_registers(const Point& point) {
  return read_range(point).count() + std::size_t{point.scale.has_exponent()};
}

/// Returns the scale of the value in these host_registers(point) registers.
inline codec::Scale scale_of(const std::uint16_t* registers, const Point& point) {
  codec::Scale scale = point.scale;
  if (!scale.has_exponent()) return scale;
  const auto exponent = static_cast<std::int16_t>(registers[read_range(point).count()]);
  scale.gain = exponent < 0 ? scale.gain / std::pow(10.0, -exponent) : scale.gain * std::pow(10.0, exponent);
  return scale;
}

/// Returns the published value in these host_registers(point) registers, of a point of a scalable type.
inline double published(const std::uint16_t* registers, const Point& point) {
  return codec::published(registers, point.format, scale_of(registers, point));
}

}  // namespace coupler
