// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "coupler/device/core/image.hpp"
#include "coupler/device/core/statistics.hpp"
#include "coupler/device/core/watchdog.hpp"
#include "coupler/map/identity.hpp"

namespace coupler::device {

/// Writes what the node says of itself (coupler/map/identity.hpp) into its area of the image: what never
/// changes.
void write_identity(const Map& map, const identity::Machine& machine, Image& image);

/// The same for counters and watchdog, which are brought up to date whenever a client reads there.
void write_statistics(const Statistics& statistics, TimePoint now, Image& image);
void write_watchdog(const OutputWatchdog& watchdog, TimePoint now, Image& image);

}  // namespace coupler::device
