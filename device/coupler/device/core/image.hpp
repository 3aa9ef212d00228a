// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "coupler/base/span.hpp"
#include "coupler/map/map.hpp"

namespace coupler::device {

/// The process image: one cell for each mapped address. A bit is 0 or 1, a register stands as on the wire.
/// The identity area (coupler/map/identity.hpp) is part of it.
class Image {
 public:
  /// Addresses without a hole between them.
  struct Area {
    std::uint32_t start = 0;
    std::uint32_t end = 0;   ///< one past the last
    std::uint32_t cell = 0;  ///< of `start`
  };

  /// Holds initial values. The storage is as large as node_memory() says (coupler/map/image_layout.hpp) and
  /// outlives the image.
  Image(const Map& map, Span<Area> areas, Span<std::uint16_t> cells);

  /// The addresses of a table that are mapped, sorted.
  Span<const Area> mapped(Table table) const { return mapped_[index(table)]; }

  /// The cells of the range; empty if one of its addresses is not mapped.
  Span<std::uint16_t> find(Table table, modbus::Range range) const;

  /// The same for a client's read: every address must also belong to a readable point.
  Span<std::uint16_t> find_readable(Table table, modbus::Range range) const;

  /// The same for a client's write: every address must also belong to a writable point.
  Span<std::uint16_t> find_writable(Table table, modbus::Range range) const;

  /// The cells of all bits: coils, then discrete inputs.
  Span<std::uint16_t> bits() const { return cells_.first(bits_); }

 private:
  std::array<Span<Area>, 4> mapped_;  ///< by table, sorted
  std::array<Span<Area>, 4> readable_;
  std::array<Span<Area>, 4> writable_;  ///< the same; empty for the input tables
  Span<std::uint16_t> cells_;
  std::size_t bits_ = 0;
};

}  // namespace coupler::device
