// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "coupler/map/loader/load.hpp"

namespace coupler::cli {

/// Loads the map for a command that gives addresses to its new points, and writes its lock if that changes.
/// With `locked` nothing is written, and what would be is an error. A lock that cannot be written is a
/// diagnostic, and there is no map.
LoadResult load_and_lock(const std::string& path, bool locked);

/// What was written, as lines for people; empty if nothing was.
std::string lock_report(const NewLock& lock);

}  // namespace coupler::cli
