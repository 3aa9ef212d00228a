// SPDX-License-Identifier: Apache-2.0
// How a snapshot of a device is shown, to people and to scripts. Texts of the device are made harmless for a
// terminal.
#pragma once

#include <string>
#include <vector>

#include "coupler/map/diagnostic.hpp"
#include "coupler/tools/snapshot.hpp"

namespace coupler::tools {

/// "21.5 °C", or why there is no value.
std::string value_text(const Map& map, const Reading& reading);

/// The lines of a table: which device, one point a line, the notes. What has changed begins with * and, with
/// colours, is bold.
std::vector<std::string> table_lines(const Map& map, const Snapshot& now, Colour colour);

/// Returns what is new after `before` (nullptr: everything is), one line each: points, offline, online again.
std::vector<std::string> change_lines(const Map& map, const Snapshot* before, const Snapshot& now);

// A terminal that shows the same lines again and again, by ANSI sequences.

/// To be printed before the first frame. It clears the screen and turns line wrapping off, so that each line
/// is one row.
constexpr auto begin_frames = "\033[?7l\033[2J";
/// To be printed after the last frame. It turns line wrapping on again.
constexpr auto end_frames = "\033[?7h";

/// Returns the text that draws the lines over the previous frame. If they do not all fit into `rows`, the
/// last row says how many are left out.
std::string frame(const std::vector<std::string>& lines, std::size_t rows);

/// One line of JSON. docs/commands.md has a table of its fields.
std::string dump_json(const Map& map, const Snapshot& now);

}  // namespace coupler::tools
