// SPDX-License-Identifier: Apache-2.0
// Names of points in letters that a topic cannot have: "Ölstand" becomes "oelstand".
#pragma once

#include <vector>

#include "coupler/map/loader/problems.hpp"
#include "coupler/tools/formats/importers.hpp"

namespace coupler::formats {

/// Writes names with letters of other alphabets than ASCII in its small letters, and tells each. A name with
/// a letter for which there is none, and one that another point has then, is an error.
void spell_names(std::vector<ForeignUnit>& units, loader::Problems& problems);

}  // namespace coupler::formats
