// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "coupler/device/node/node_runtime.hpp"
#include "coupler/device/node/options.hpp"
#include "coupler/device/node/stderr_log.hpp"
#include "coupler/map/map.hpp"

namespace coupler::device {

/// Serves the map until a signal asks to stop, then drives the outputs to their safe state. SIGHUP makes it
/// read the map again, unless `again` is empty. `hooks`, which may be null, are behind its points. Says
/// in the log what it does, which waits for nobody from then on. Returns the exit status: 0 stopped, 1 a node
/// cannot serve this map, 3 network or hardware cannot be had, or an output could not be driven to its safe
/// state at the end.
int serve(const Map& map, const Options& options, StderrLog& log, const ReadMap& again, Hooks* hooks);

}  // namespace coupler::device
