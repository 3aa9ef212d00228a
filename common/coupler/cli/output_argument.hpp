// SPDX-License-Identifier: Apache-2.0
// What --out names: a file or a folder, or standard output.
#pragma once

#include <cstdio>
#include <string>
#include <string_view>

#include "coupler/cli/commands.hpp"
#include "coupler/generate/output.hpp"

namespace coupler::cli {

/// As --out, in the place of a file.
constexpr std::string_view standard_output = "-";

/// It is not given, or standard output.
inline bool names_no_file(const std::string& out) { return out.empty() || out == standard_output; }

/// Writes what a command makes: to standard output if `out` names no file. Returns how the command ends.
inline Exit write_out(std::string_view command, const std::string& out, const std::string& text) {
  if (names_no_file(out)) {
    std::fputs(text.c_str(), stdout);
    return ok;
  }
  if (const auto outcome = generate::write_if_changed(out, text); !outcome)
    return complain(command, bad_call, outcome.error(), "give a file that you may write with --out");
  return ok;
}

}  // namespace coupler::cli
