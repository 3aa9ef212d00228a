// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "coupler/map/loader/document.hpp"

namespace coupler::formats {

/// The tree of a map as a YAML file in this project's style: the device's keys in the order of the key table,
/// then `mapping:` with one line a point; words of choices as the documentation spells them. Keys that no map
/// has, and tables without points, are left out. `comment` is the first line.
std::string write_map(const loader::Entry& map, std::string_view comment);

/// A value as it may stand in one line of YAML, inside brackets or not: 5, "two words", {of: pulse}.
std::string flow(const loader::Entry& value);

}  // namespace coupler::formats
