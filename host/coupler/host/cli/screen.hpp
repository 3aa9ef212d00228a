// SPDX-License-Identifier: Apache-2.0
// A terminal that shows the same lines again and again, by ANSI sequences.
#pragma once

#include <string>
#include <vector>

namespace coupler::cli {

/// Columns do not wrap: a line is one row. To be printed before the first frame …
constexpr auto begin_frames = "\033[?7l\033[2J";
/// … and after the last one.
constexpr auto end_frames = "\033[?7h";

/// The lines in place of those of the frame before. Where not all fit into `rows`, the last row says how many
/// there are.
std::string frame(const std::vector<std::string>& lines, std::size_t rows);

}  // namespace coupler::cli
