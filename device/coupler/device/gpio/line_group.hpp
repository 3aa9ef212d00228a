// SPDX-License-Identifier: Apache-2.0
// What a backend offers: lines that one call drives or reads together. Levels are logical, 0 or 1.
#pragma once

#include <cstddef>
#include <string>

#include "coupler/base/span.hpp"
#include "coupler/device/core/time.hpp"

namespace coupler::device {

constexpr std::size_t max_group_size = 64;  ///< what one request to the kernel holds

class LineGroup {
 public:
  virtual ~LineGroup() = default;
  /// For the log: "gpiochip0 lines 5 (GPIO5), 6 (GPIO6)".
  virtual const std::string& name() const = 0;
  /// False: its chip was unplugged. Asks the kernel, not the chip.
  virtual bool is_plugged() { return true; }
};

class OutputGroup : public LineGroup {
 public:
  /// All lines of the group at once. Returns 0 or an errno; then none of them counts as driven.
  [[nodiscard]] virtual int drive(Span<const int> levels) = 0;
  /// The levels that the lines have, as far as the chip can tell. Returns 0 or an errno.
  [[nodiscard]] virtual int read(Span<int> levels) = 0;
};

class InputGroup : public LineGroup {
 public:
  /// All lines of the group at once. Returns 0 or an errno.
  [[nodiscard]] virtual int read(Span<int> levels, TimePoint now) = 0;
};

}  // namespace coupler::device
