// SPDX-License-Identifier: Apache-2.0
// A map as version control has it: REVISION:PATH, as git takes it.
#pragma once

#include <string>

#include "coupler/map/loader/load.hpp"

namespace coupler::cli {

/// Not a file, and of the form REVISION:PATH.
bool names_a_revision(const std::string& argument);

/// Runs `git show`; the lock is that of the same revision. What git says is a diagnostic.
LoadResult load_revision(const std::string& argument);

}  // namespace coupler::cli
