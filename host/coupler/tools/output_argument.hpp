// SPDX-License-Identifier: Apache-2.0
// What --out names: a file or a folder, or standard output.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>

#include <tl/expected.hpp>

#include "coupler/tools/commands.hpp"

namespace coupler::tools {

/// The word that stands for standard output in place of a file.
constexpr std::string_view standard_output = "-";

/// Returns whether --out is not given or is standard output.
inline bool names_no_file(const std::string& out) { return out.empty() || out == standard_output; }

/// Returns whether a command may make the file that --out names, if it names one: whether its folder is
/// there, and the file is not, or may be replaced. To be asked before a device is.
tl::expected<void, Failure> can_make(const std::string& out, bool force);

/// Writes what a command makes: to standard output if `out` names no file. Returns how the command ends.
Exit write_out(std::string_view command, const std::string& out, const std::string& text);

/// Writes a file that a command makes from a map, but never over the map itself. `option` is the option that
/// named the file. Returns how the command ends.
Exit write_beside_map(std::string_view command, const std::string& map, std::string_view option,
                      const std::string& file, const std::string& text);

/// Returns whether the file exists, is not empty, and has none of `marks`: another program or a
/// person wrote it.
bool has_none_of(const std::string& file, std::initializer_list<std::string_view> marks);

}  // namespace coupler::tools
