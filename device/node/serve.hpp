// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/map/map.hpp"
#include "device/node/options.hpp"
#include "device/node/station.hpp"

namespace coupler::node {

/// Serves the map until a signal asks to stop, then drives the outputs to their safe state. SIGHUP makes it
/// read the map again, unless `read_again` is empty. `hooks`, which may be null, are behind its points. Says
/// on stderr what it does. Returns the exit status: 0 stopped, 1 a node cannot serve this map, 3 network or
/// hardware cannot be had, or an output could not be driven to its safe state at the end.
int serve(const Map& map, const Options& options, const ReadAgain& read_again = {}, Hooks* hooks = nullptr);

}  // namespace coupler::node
