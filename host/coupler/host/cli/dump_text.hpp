// SPDX-License-Identifier: Apache-2.0
// What a look at a device is to a person. Texts of the device are made harmless for a terminal.
#pragma once

#include <string>
#include <vector>

#include "coupler/host/cli/snapshot.hpp"
#include "coupler/map/diagnostic.hpp"

namespace coupler::cli {

/// "21.5 °C", or why there is no value.
std::string value_text(const Map& map, const Reading& reading);

/// Everything as a table, its lines: which device, one point a line, the notes. What has changed begins with
/// * and, with colours, is bold.
std::vector<std::string> table_lines(const Map& map, const Snapshot& now, Colour colour);

/// What is news after `before` (nullptr: everything is), one line each: points, offline, online again.
std::vector<std::string> change_lines(const Map& map, const Snapshot* before, const Snapshot& now);

}  // namespace coupler::cli
