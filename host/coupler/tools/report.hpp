// SPDX-License-Identifier: Apache-2.0
// What commands print of a map that was read: text for people, JSON for programs.
#pragma once

#include <string>

#include "coupler/map/diagnostic.hpp"
#include "coupler/map/loader/load.hpp"

namespace coupler::tools {

/// "device.yaml: ok: device, 3 points (1 coil, 2 discrete inputs), fingerprint 0123456789abcdef"
std::string summary(const std::string& file, const Map& map);

/// Returns the margin that MoveIt needs in order not to cancel goals of tools; empty if no tool has a joint
/// or positions.
std::string moveit_margin(const Map& map);

/// Returns a table of the points that each role may read and write; empty without `security`.
std::string rights_table(const Map& map);

/// Returns the lines that say what was written of a lock; empty if nothing was.
std::string lock_report(const NewLock& lock);

/// Returns one line of JSON: {file, ok, name, points, fingerprint, lock, diagnostics: [{severity, file, line,
/// column, what, remedy, notes: [{line, column, what}]}]}. name, points and fingerprint are null if there is
/// no map; lock is null unless it was written, and otherwise {file, allocated: [names], retired: [names]}.
std::string json_report(const std::string& file, const LoadResult& loaded);

}  // namespace coupler::tools
