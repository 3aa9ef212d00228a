// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>

#include "coupler/base/span.hpp"
#include "coupler/map/service.hpp"
#include "coupler/map/table.hpp"
#include "coupler/modbus/exception.hpp"

namespace coupler {

/// How the host makes use of the watchdog that a coupler of another maker has of its own: what `preset` knows
/// of it, for the `watchdog` of the map. Each write is a request by itself, in this order. Deployment: not in
/// the fingerprint.
struct WatchdogSequences {
  /// One coil or holding register.
  struct Write {
    Table table = Table::holding_registers;
    std::uint16_t address = 0;  ///< on the wire
    std::uint16_t value = 0;    ///< a coil's is 0 or 1
    /// It is read first, and left alone if it has the value: some refuse to be written at certain times.
    bool if_different = false;
  };

  std::chrono::milliseconds timeout{0};  ///< 0: the coupler's watchdog is none of the host's business
  Watchdog::Recovery recovery = Watchdog::Recovery::automatic;
  std::chrono::milliseconds feed_every{0};     ///< a part of the timeout
  Span<const Write> arm{};                     ///< after each connect, before anything else is written
  Span<const Write> feed{};                    ///< one at a time, in turn. Empty: any request feeds
  Span<const Write> reset{};                   ///< after it has expired; then it is armed again
  std::optional<modbus::Exception> refusal{};  ///< expired: process data is answered with it
  std::optional<Write> alarm{};                ///< expired: this one reads as its value

  constexpr bool present() const { return timeout.count() > 0; }
};

}  // namespace coupler
