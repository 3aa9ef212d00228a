// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "coupler/map/map.hpp"

namespace coupler::generate {

/// Where it is: "holding_registers 3-4", "coils 0", "holding_registers 7, bit 3".
std::string place(const Point& point);

/// The point as an aggregate, `{"lamp", Table::coils, 0, …}`, under a comment that says what it is and where.
/// Fields that a reader expects at their default are left to it.
std::string row(const Point& point);

std::string row(const SimWire& wire);

std::string row(const Unreadable& area);

/// What the host writes for the watchdog of a coupler.
std::string row(const WatchdogSequences::Write& write);

/// One of the addresses that may connect.
std::string row(std::string_view address);

}  // namespace coupler::generate
