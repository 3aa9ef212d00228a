// SPDX-License-Identifier: Apache-2.0
// Outputs become safe when clients fall silent: the watchdog of a node, and how the driver uses the watchdog
// of another maker's coupler.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string_view>

#include "coupler/base/enumeration.hpp"
#include "coupler/base/span.hpp"
#include "coupler/map/table.hpp"
#include "coupler/modbus/pdu.hpp"

namespace coupler {

/// Outputs go to their safe state when a client that has written falls silent.
struct Watchdog {
  enum class FedBy : std::uint8_t {
    any,   ///< every request that is carried out, of a connection that has written an output
    write  ///< only their writes to outputs
  };
  enum class Recovery : std::uint8_t {
    automatic,  ///< the next write is carried out and arms it again
    manual      ///< writes to outputs (with a line, a channel or a hook) answer 04 until 0xAA55 is written to
                ///< holding register 0xFF00
  };
  std::chrono::milliseconds timeout{0};  ///< 0: there is no watchdog
  FedBy fed_by = FedBy::any;
  Recovery recovery = Recovery::automatic;

  constexpr bool present() const { return timeout.count() > 0; }
  constexpr bool needs_reset() const { return present() && recovery == Recovery::manual; }
};

constexpr Enumeration<Watchdog::FedBy, 2> enumeration(Watchdog::FedBy) {
  return {"Watchdog::FedBy", {{Watchdog::FedBy::any, "any"}, {Watchdog::FedBy::write, "write"}}};
}
constexpr Enumeration<Watchdog::Recovery, 2> enumeration(Watchdog::Recovery) {
  using Recovery = Watchdog::Recovery;
  return {"Watchdog::Recovery", {{Recovery::automatic, "automatic"}, {Recovery::manual, "manual"}}};
}

/// How the host uses the watchdog of another maker's coupler: what the preset knows of it, with the settings
/// of the map. Each write is a request of its own, in this order. Not in the fingerprint.
struct WatchdogSequences {
  /// One coil or holding register.
  struct Write {
    Table table = Table::holding_registers;
    std::uint16_t address = 0;  ///< zero-based
    std::uint16_t value = 0;    ///< a coil's is 0 or 1
    /// Read first, and written only if the value differs: some cannot be written at all times.
    bool if_different = false;
  };

  std::chrono::milliseconds timeout{0};  ///< 0: the host does not use the coupler's watchdog
  Watchdog::Recovery recovery = Watchdog::Recovery::automatic;
  std::chrono::milliseconds feed_every{0};     ///< a part of the timeout
  Span<const Write> arm{};                     ///< after each connect, before anything else is written
  Span<const Write> feed{};                    ///< one at a time, in turn. Empty: any request feeds
  Span<const Write> reset{};                   ///< after it has expired; then it is armed again
  std::optional<modbus::Exception> refusal{};  ///< the answer to process data after the watchdog has expired
  std::optional<Write> alarm{};                ///< reads as its value after the watchdog has expired

  constexpr bool present() const { return timeout.count() > 0; }
};

}  // namespace coupler
