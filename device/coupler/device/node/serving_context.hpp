// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <tl/expected.hpp>

#include "coupler/device/analogue/sysfs_channels.hpp"
#include "coupler/device/core/channels.hpp"
#include "coupler/device/core/hardware.hpp"
#include "coupler/device/gpio/wiring.hpp"
#include "coupler/device/net/listener.hpp"
#include "coupler/device/node/options.hpp"
#include "coupler/device/node/serve_error.hpp"
#include "coupler/device/node/shared_state.hpp"
#include "coupler/map/owned_map.hpp"

namespace coupler::device {

/// Checks whether a node can serve this map, which is stricter than the rules for a map of any other coupler.
/// The error names the points that prevent it, one a line, and what to do.
tl::expected<void, std::string> check_servable(const Map& map);

/// A map and all that it takes to serve it. It outlives the processes that do.
struct ServingContext {
  /// Makes what is needed to serve the map, after `before` (null if there was no other). Network and channels
  /// come first, so a program that then cannot serve the outputs does not touch them: requesting a line
  /// drives it, but opening a channel does not. `hooks` may be null.
  static tl::expected<std::unique_ptr<ServingContext>, ServeError> prepare(const Map& map, MapPtr owner,
                                                                           const Options& options,
                                                                           const ServingContext* before,
                                                                           Hooks* hooks, Log& log);

  MapPtr owner;  ///< null: the map is not owned
  const Map* map = nullptr;
  std::string address;  ///< that the listener was asked for
  std::uint16_t port = 0;
  Listener listener;
  std::uint16_t tls_port = 0;
  std::optional<Listener> tls_listener{};    ///< nullopt: the map has no TLS
  std::unique_ptr<PreparedWiring> prepared;  ///< before it is in force
  std::unique_ptr<Wiring> wiring;            ///< when it is
  std::unique_ptr<SharedState> state;
  std::unique_ptr<SysfsChannels> channels;   ///< null: no register has one
  std::unique_ptr<Channels> simulated;       ///< in place of those; null: not simulated
  std::unique_ptr<AnaloguePoints> analogue;  ///< the points that have either; null: there is neither
  std::unique_ptr<HookedPoints> hooked;      ///< null: no firmware's code is behind points

  /// Uses channels again whose device is plugged in again; drives outputs as before, or safe if `safe`. True:
  /// there are some.
  bool reconnect_channels(bool safe);

  /// In a process that was forked while another context is in force, or may still be refused: otherwise its
  /// ports, and lines that only it has requested, would stay taken for as long as that process lives.
  void leave() {
    listener.socket.close();
    if (tls_listener) tls_listener->socket.close();
    prepared = nullptr;
  }

  /// Returns whether clients need not notice when one is replaced by the other.
  bool looks_like(const ServingContext& other) const;
  /// Returns whether its watchdog has expired.
  bool has_expired() const { return state->watchdog().state() == OutputWatchdog::State::expired; }
  /// Once it is in force.
  Hardware hardware() const { return {wiring->lines(), analogue.get(), hooked.get()}; }
};

}  // namespace coupler::device
