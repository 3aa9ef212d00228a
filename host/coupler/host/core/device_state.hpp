// SPDX-License-Identifier: Apache-2.0
// The states of the connection to a device, and what changes them. docs/architecture.md shows the table.
#pragma once

#include <cstddef>
#include <cstdint>

#include "coupler/base/enumeration.hpp"

namespace coupler::host {

/// Each state includes those before it.
enum class DeviceState : std::uint8_t {
  closed,    ///< no connection; the next attempt follows after the back-off
  open,      ///< connected to the device or to its gateway
  verified,  ///< the maps are equal, or `verify` accepts the difference: reads and writes may be sent
  online     ///< the device has answered
};

enum class DeviceEvent : std::uint8_t {
  connected,  ///< the connection is there
  verified,   ///< the checks and writes of a new connection are done
  answered,   ///< the device answered a request
  away,       ///< the gateway cannot reach the unit (exceptions 0A and 0B); other units use the connection
  lost        ///< any other error, or the end of the program
};

constexpr Enumeration<DeviceState, 4> enumeration(DeviceState) {
  using State = DeviceState;
  return {"DeviceState",
          {{State::closed, "closed"},
           {State::open, "open"},
           {State::verified, "verified"},
           {State::online, "online"}}};
}
constexpr Enumeration<DeviceEvent, 5> enumeration(DeviceEvent) {
  using Change = DeviceEvent;
  return {"DeviceEvent",
          {{Change::connected, "connected"},
           {Change::verified, "verified"},
           {Change::answered, "answered"},
           {Change::away, "away"},
           {Change::lost, "lost"}}};
}

/// Returns the state after `event`. An event that a state cannot have changes nothing.
constexpr DeviceState after(DeviceState state, DeviceEvent event) {
  constexpr auto closed = DeviceState::closed;
  constexpr auto open = DeviceState::open;
  constexpr auto verified = DeviceState::verified;
  constexpr auto online = DeviceState::online;
  constexpr DeviceState next[4][5] = {
      // connected verified  answered  away    lost
      {open, closed, closed, closed, closed},      // closed
      {open, verified, open, open, closed},        // open
      {verified, verified, online, open, closed},  // verified
      {online, online, online, open, closed},      // online
  };
  return next[static_cast<std::size_t>(state)][static_cast<std::size_t>(event)];
}

}  // namespace coupler::host
