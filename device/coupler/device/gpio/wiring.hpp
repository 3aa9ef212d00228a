// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "coupler/device/core/lines.hpp"
#include "coupler/device/core/log.hpp"
#include "coupler/device/gpio/line_group.hpp"
#include "coupler/map/map.hpp"

namespace coupler::device {

class PreparedWiring;

/// The hardware of a map in use. It belongs to one process; those that it forks may use the lines, too.
class Wiring {
 public:
  using Prepared = tl::expected<std::unique_ptr<PreparedWiring>, std::string>;

  virtual ~Wiring() = default;
  virtual Lines& lines() = 0;
  /// The groups whose descriptors the user of the lines has to watch. Owned by this.
  virtual std::vector<InputGroup*> event_sources() const { return {}; }
  /// The outputs in groups: where hardware hangs, so does what is called for its group, and for no other.
  virtual std::size_t output_groups() const { return 1; }
  /// Returns a text for the log: "gpiochip0 lines 5 (GPIO5), 6 (GPIO6)".
  virtual std::string name_of_outputs([[maybe_unused]] std::size_t group) const { return "the lines"; }
  /// Lines::drive_safe() for one group.
  [[nodiscard]] virtual bool drive_safe([[maybe_unused]] std::size_t group) { return lines().drive_safe(); }
  /// The group's hardware hangs: in this process, what needs it fails from now on.
  virtual void give_up_outputs([[maybe_unused]] std::size_t group) {}
  /// See prepare_wiring(); this is the wiring before.
  virtual Prepared prepare_next(const Map& map, bool safe, Log& log) = 0;

  /// Releases lines whose chip was unplugged, and requests them again when it is plugged in again, its
  /// outputs driven as before, or safe if `safe`. True: something changed, so processes that were forked
  /// before have lines that are gone.
  virtual bool reconnect([[maybe_unused]] bool safe) { return false; }
  /// None of those processes serves any more: outputs that reconnect() has requested again have the levels
  /// that the last one has left, be it meanwhile.
  virtual void settle() {}
};

/// The future wiring of a map, after another one or as the first. Its lines that nobody held are requested
/// already, and no output has moved.
class PreparedWiring {
 public:
  virtual ~PreparedWiring() = default;
  /// Replaces the wiring before, which cannot be used any more, nor can its copies in other processes. Lines
  /// that both have keep their level. Outputs that are not wanted any more go to their safe state.
  virtual std::unique_ptr<Wiring> take_over() = 0;
};

/// The hardware of the map: simulated, or its GPIO lines by libgpiod, with new outputs at their initial
/// levels, or safe if `safe`. A map without lines needs neither. `before` (may be null) is of the same kind
/// and still in use. The error names chip, line and holder of each line that cannot be requested, and what to
/// do; it may have several lines. `map`, `log` and `before` outlive the result and the wiring that it
/// becomes; the map of `before` lives until take_over().
Wiring::Prepared prepare_wiring(const Map& map, bool simulated, Wiring* before, bool safe, Log& log);

}  // namespace coupler::device
