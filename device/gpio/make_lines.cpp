// SPDX-License-Identifier: Apache-2.0
#include "device/gpio/make_lines.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "device/gpio/grouped_lines.hpp"
#include "device/gpio/simulated_chip.hpp"
#ifdef COUPLER_WITH_GPIOD
#include "device/gpio/wire.hpp"
#endif

namespace coupler::node {

tl::expected<Wiring, std::string> make_lines(const Map& map, bool simulated, Log& log) {
  if (simulated) return Wiring{std::make_unique<SimulatedChip>(map, TimePoint::clock::now()), {}};

  const auto* wired =
      std::find_if(map.points.begin(), map.points.end(), [](const auto& p) { return p.line.present(); });
  if (wired == map.points.end())
    return Wiring{
        std::make_unique<GroupedLines>(std::vector<WiredOutputs>(), std::vector<WiredInputs>(), log), {}};
#ifdef COUPLER_WITH_GPIOD
  return wire(map, log);
#else
  return tl::unexpected(
      fmt::format("point '{}' has a GPIO line, but this program was built without libgpiod; "
                  "install libgpiod-dev and build again, or run with --sim",
                  wired->name));
#endif
}

}  // namespace coupler::node
