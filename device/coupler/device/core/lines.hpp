// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "coupler/base/span.hpp"
#include "coupler/device/core/edges.hpp"
#include "coupler/device/core/time.hpp"
#include "coupler/map/hardware.hpp"
#include "coupler/modbus/range.hpp"

namespace coupler::device {

/// The level of an output that is at `now` once it is in its safe state.
constexpr int safe_level(Safe safe, int now) { return safe == Safe::hold ? now : safe == Safe::on ? 1 : 0; }

/// The hardware behind coils and discrete inputs. Points without a line are none of its business. Levels are
/// logical (after active_low): 0 or 1. Whoever implements it says in the log what failed, once per change of
/// state.
class Lines {
 public:
  virtual ~Lines() = default;

  /// Overwrites in `levels`, which has one element for each address of `inputs`, those that have a line.
  /// False if a line cannot be read.
  [[nodiscard]] virtual bool read(modbus::Range inputs, Span<std::uint16_t> levels, TimePoint now) = 0;

  /// Tells, since the last call, the edges of the inputs that counters and latched points name, and each
  /// change of every input that has a line. Hardware that sees neither tells none.
  virtual void take_edges(TimePoint, EdgeSink&) {}

  /// When take_edges() is to be called again although no descriptor became ready: a debounce period is over
  /// then, or a level has to be looked at. It may be in the past. nullopt: not for that.
  virtual std::optional<TimePoint> next_change(TimePoint) const { return std::nullopt; }

  /// Returns whether it has to be called then although nobody asks for changes, because there are inputs to
  /// be debounced whose edges nothing reports.
  virtual bool has_to_look() const { return false; }

  /// Drives those coils of the range that have a line. False if one cannot be driven: then the others are
  /// back at the levels they had.
  [[nodiscard]] virtual bool drive(modbus::Range coils, Span<const std::uint16_t> levels) = 0;

  /// Drives those coils of the range that have a line, each for itself: one that cannot be driven does not
  /// keep the others from it. False if there is one. Hardware that is unplugged may be driven so when it is
  /// plugged in again; then it counts as driven.
  [[nodiscard]] virtual bool drive_each(modbus::Range coils, Span<const std::uint16_t> levels) {
    if (drive(coils, levels)) return true;
    bool good = true;
    for (std::size_t i = 0; i < levels.size(); ++i)
      good &= drive(modbus::Range::of(static_cast<std::uint32_t>(coils.start() + i), 1), levels.sub(i, 1));
    return good;
  }

  /// False: the hardware behind one of the coils is known to be unplugged.
  virtual bool are_plugged(modbus::Range) const { return true; }

  /// Overwrites in `levels`, which has one element for each address of `coils`, those that have a line: the
  /// level that it is driven to. Returns whether there is one.
  virtual bool driven(modbus::Range coils, Span<std::uint16_t> levels) const = 0;

  /// Drives every output to its safe state (`hold` stays). Tries all of them; false if one cannot be driven.
  [[nodiscard]] virtual bool drive_safe() = 0;

  /// Returns whether somebody may play the machine by pull().
  virtual bool is_simulated() const { return false; }
  /// Gives those inputs of the range that have a simulated line a level from outside. False: one of them
  /// follows a wire, or cannot be reached; then none has changed.
  [[nodiscard]] virtual bool pull(modbus::Range, Span<const std::uint16_t>) { return false; }
};

}  // namespace coupler::device
