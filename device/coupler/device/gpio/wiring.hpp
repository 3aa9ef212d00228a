// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "coupler/device/core/lines.hpp"
#include "coupler/device/core/log.hpp"
#include "coupler/device/gpio/event_source.hpp"
#include "coupler/map/map.hpp"

namespace coupler::device {

/// The hardware of a map in use. It belongs to one process; those that it forks may use the lines, too.
class Wiring {
 public:
  virtual ~Wiring() = default;
  virtual Lines& lines() = 0;
  /// To be watched by whoever uses the lines. Owned by this.
  virtual std::vector<EventSource*> events() const { return {}; }

  /// Lets go of lines whose chip was unplugged and requests them again when it is back, its outputs driven as
  /// they were before, or safe if `safe`. True: something changed, so processes that were forked before have
  /// lines that are gone.
  virtual bool mend([[maybe_unused]] bool safe) { return false; }
};

/// What is to become the wiring of a map, after another one or as the first. Its lines that nobody held are
/// held by now; nothing has moved.
class NextWiring {
 public:
  virtual ~NextWiring() = default;
  /// Takes the place of the wiring before, which cannot be used any more, nor can its copies in other
  /// processes. Lines that both have keep their level. Outputs that are not wanted any more go to their safe
  /// state.
  virtual std::unique_ptr<Wiring> take_over() = 0;
};

/// The hardware of the map: simulated, or its GPIO lines by libgpiod, with new outputs at their initial
/// levels, or safe if `safe`. A map without lines needs neither. `before` (may be null) is in use still. The
/// error says chip, line and holder of each line that cannot be had, and the remedy; it may have several
/// lines. `map`, `log` and `before` outlive the result and what it becomes; the map of `before` lives until
/// take_over().
tl::expected<std::unique_ptr<NextWiring>, std::string> prepare_wiring(const Map& map, bool simulated,
                                                                      Wiring* before, bool safe, Log& log);

}  // namespace coupler::device
