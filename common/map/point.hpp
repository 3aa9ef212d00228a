// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

#include "common/base/span.hpp"
#include "common/codec/format.hpp"
#include "common/map/edge.hpp"
#include "common/map/line.hpp"
#include "common/map/table.hpp"
#include "common/modbus/range.hpp"

namespace coupler {

/// What the master may do with a point.
enum class Access : std::uint8_t { read, write, read_write };

/// One named value of a coupler. A literal type, so that a generated table is constant data.
struct Point {
  std::string_view name;  ///< a valid ROS name, unique in the map
  Table table = Table::coils;
  std::uint16_t address = 0;  ///< on the wire
  codec::Format format;
  Access access = Access::read;
  /// The value at start: codec::registers(format) registers as they stand on the wire, the bits of other
  /// points zero (for bit tables one element, 0 or 1). Empty: all zero.
  Span<const std::uint16_t> initial;
  Safe safe = Safe::off;  ///< coils with a line
  Line line;
  std::string_view description;
  std::string_view units;
  EdgeOf counter{};  ///< a register that counts an input's edges; a holding register can be preset
  EdgeOf latched{};  ///< a coil, or a bit of a holding register: set by the edge, cleared by writing 0
};

/// The addresses it occupies in its table (partial values: the register they share).
constexpr modbus::Range range(const Point& point) {
  return modbus::Range::of(point.address, codec::registers(point.format));
}

constexpr bool is_readable(const Point& point) { return point.access != Access::write; }
constexpr bool is_writable(const Point& point) { return point.access != Access::read; }

/// Shares its register with others. Bits of the bit tables share nothing.
constexpr bool is_partial(const Point& point) {
  return !holds_bits(point.table) && codec::is_partial(point.format);
}

}  // namespace coupler
