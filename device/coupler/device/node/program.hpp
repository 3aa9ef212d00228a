// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "coupler/base/descriptor.hpp"
#include "coupler/device/core/hooks.hpp"
#include "coupler/map/map.hpp"

namespace coupler::device {

struct Options;
struct ReadMap;
class StderrLog;

/// The whole of a node whose map is built in: options, service, exit status (0 ok, 1 the map cannot be
/// served, 2 wrong command line, 3 network or hardware failed). Generated programs call only this.
int main_with(const Map& map, int argc, char** argv);

/// The same with a firmware's code behind the points.
int main_with(const Map& map, Hooks& hooks, int argc, char** argv);

/// Serves the map until a signal asks to stop, then drives the outputs to their safe state. `settings`: as
/// MapRead. SIGHUP makes it read the map again, unless `again` is empty. `hooks`, which may be null, are
/// behind its points. From now on the log waits for nobody. Returns the exit status: 0 stopped, 1 a node
/// cannot serve this map, 3 network or hardware failed, or an output could not be driven to its safe state at
/// the end.
int serve(const Map& map, Descriptor settings, const Options& options, StderrLog& log, const ReadMap& again,
          Hooks* hooks);

}  // namespace coupler::device
