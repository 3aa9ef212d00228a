// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "coupler/device/core/hooks.hpp"
#include "coupler/modbus/limits.hpp"

namespace coupler::device {

/// Writes to points that a firmware's code is behind, and what that code sets. The image holds what it
/// accepted.
class HookedPoints {
 public:
  /// All of them outlive it.
  HookedPoints(const Map& map, Image& image, Hooks& hooks) : map_(map), image_(image), hooks_(hooks) {}

  void put_new_values() { hooks_.put_new_values(image_); }

  /// Asks about the points that have an address in the range, in the order of their addresses, what `next`
  /// says: one element for each. A point that is written in part is asked about as a whole; one that shares
  /// its register only if its own bits change. False if one is refused: then the others have their values
  /// again.
  [[nodiscard]] bool write(Table table, modbus::Range range, Span<const std::uint16_t> next);

  /// Gives the points that write() has just accepted their values again.
  void take_back(Table table, modbus::Range range, Span<const std::uint16_t> next);

  /// Whether the range has an address of such an output.
  bool has_output(Table table, modbus::Range range) const;

  void make_safe() { hooks_.make_safe(); }

 private:
  struct Indices {
    std::uint32_t first;
    std::uint32_t end;
  };
  Indices touched(Table table, modbus::Range range) const;
  bool is_asked(std::uint32_t point, modbus::Range range, Span<const std::uint16_t> next);
  Span<const std::uint16_t> before(std::uint32_t point) const;
  void take_back(Indices points, modbus::Range range, Span<const std::uint16_t> next);

  const Map& map_;
  Image& image_;
  Hooks& hooks_;
  std::array<std::uint16_t, modbus::max_read_bits> value_{};  ///< of the point that is asked about
};

}  // namespace coupler::device
