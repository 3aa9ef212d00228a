// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "common/map/map.hpp"
#include "device/core/lines.hpp"
#include "device/core/log.hpp"
#include "device/gpio/event_source.hpp"

namespace coupler::node {

struct Wiring {
  std::unique_ptr<Lines> lines;
  std::vector<EventSource*> events;  ///< owned by `lines`
};

/// The hardware of the map: simulated, or its GPIO lines by libgpiod, with outputs at their initial levels. A
/// map without lines needs neither. The error says chip, line and holder of each line that cannot be had, and
/// the remedy; it may have several lines. `map` and `log` outlive the
/// result.
tl::expected<Wiring, std::string> make_lines(const Map& map, bool simulated, Log& log);

}  // namespace coupler::node
