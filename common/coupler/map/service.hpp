// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <string_view>

#include "coupler/base/enumeration.hpp"
#include "coupler/base/span.hpp"

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

/// How a node serves the map.
struct Service {
  std::string_view listen;  ///< address to listen on; empty: every interface (loopback if simulated)
  Span<const std::string_view> allow{};  ///< addresses and CIDR ranges that may connect; empty: everyone
  Watchdog watchdog;
  bool readback = false;  ///< compare an output's level after driving it
};

}  // namespace coupler
