// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "coupler/base/span.hpp"
#include "coupler/device/core/edges.hpp"
#include "coupler/device/core/time.hpp"
#include "coupler/modbus/range.hpp"

namespace coupler::device {

/// The hardware behind coils and discrete inputs. Points without a line are none of its business. Levels are
/// logical (after active_low): 0 or 1. Whoever implements it says in the log what failed, once per change of
/// state.
class Lines {
 public:
  virtual ~Lines() = default;

  /// Overwrites in `levels`, which has one element for each address of `inputs`, those that have a line.
  /// False if a line cannot be read.
  [[nodiscard]] virtual bool read(modbus::Range inputs, Span<std::uint16_t> levels, TimePoint now) = 0;

  /// Tells the edges of the inputs that counters and latched points name, since the last call. Hardware that
  /// sees no edges tells none.
  virtual void take_edges(TimePoint, EdgeSink&) {}

  /// Drives those coils of the range that have a line. False if one cannot be driven: then the others are
  /// back at the levels they had.
  [[nodiscard]] virtual bool drive(modbus::Range coils, Span<const std::uint16_t> levels) = 0;

  /// Overwrites in `levels`, which has one element for each address of `coils`, those that have a line: the
  /// level that it is driven to. Returns whether there is one.
  virtual bool driven(modbus::Range coils, Span<std::uint16_t> levels) const = 0;

  /// Drives every output to its safe state (`hold` stays). Tries all of them; false if one cannot be driven.
  [[nodiscard]] virtual bool drive_safe() = 0;
};

}  // namespace coupler::device
