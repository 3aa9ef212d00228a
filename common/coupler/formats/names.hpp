// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "coupler/map/loader/document.hpp"
#include "coupler/map/loader/problems.hpp"

namespace coupler::formats {

/// The nearest valid ROS name: what is not a letter, digit or '_' becomes '_', and what begins otherwise gets
/// `prefix` in front. '/' stays where a name may have it.
std::string mended_name(std::string_view name, std::string_view prefix);

/// Gives every point of the tree a valid name of its own, and tells of each one that it changed.
void mend_point_names(loader::Entry& map, loader::Problems& problems);

}  // namespace coupler::formats
