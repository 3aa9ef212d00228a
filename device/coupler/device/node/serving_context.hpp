// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "coupler/device/analogue/sysfs_channels.hpp"
#include "coupler/device/core/hardware.hpp"
#include "coupler/device/gpio/wiring.hpp"
#include "coupler/device/net/listener.hpp"
#include "coupler/device/node/shared_state.hpp"
#include "coupler/map/owned_map.hpp"

namespace coupler::device {

/// A map and all that it takes to serve it. It outlives the processes that do.
struct ServingContext {
  MapPtr owner;  ///< null: the map is somebody else's
  const Map* map = nullptr;
  std::string address;  ///< that the listener was asked for
  std::uint16_t port = 0;
  Listener listener;
  std::unique_ptr<NextWiring> prepared;  ///< before it is in force
  std::unique_ptr<Wiring> wiring;        ///< when it is
  std::unique_ptr<SharedState> state;
  std::unique_ptr<SysfsChannels> channels;   ///< null: no register has one
  std::unique_ptr<AnaloguePoints> analogue;  ///< the points that have them; null as well
  std::unique_ptr<HookedPoints> hooked;      ///< null: no firmware's code is behind points

  /// Channels whose device is back are used again, outputs driven as they were before, or safe if `safe`.
  /// True: there are some.
  bool mend_channels(bool safe) {
    if (!channels) return false;
    const auto mended = channels->mend();
    for (const Point* point : mended)
      if (is_writable(point->table)) (void)analogue->drive(*point, safe);
    return !mended.empty();
  }

  bool has_expired() const { return state->watchdog().state() == OutputWatchdog::State::expired; }
  /// Once it is in force.
  Hardware hardware() const { return {wiring->lines(), analogue.get(), hooked.get()}; }
};

}  // namespace coupler::device
