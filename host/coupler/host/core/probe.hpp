// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "coupler/host/core/transport.hpp"
#include "coupler/map/map.hpp"

namespace coupler::host {

/// Asks for something only to hear whether the device is there: the first point that can be read, or else
/// coil 0. An exception is an answer, unless it says that the unit is away.
Result<> probe(const Map& map, Transport& transport);

}  // namespace coupler::host
