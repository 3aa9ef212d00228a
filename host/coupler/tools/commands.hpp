// SPDX-License-Identifier: Apache-2.0
// The subcommands of `coupler`, and how they end. Each add_ function adds one subcommand to the program, and
// the subcommand sets `exit` when it has run. absent.cpp has stubs for those that a build lacks.
#pragma once

#include <cstdio>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <tl/expected.hpp>

#include "coupler/command_line/command_line.hpp"
#include "coupler/map/printable.hpp"

namespace coupler::tools {

using command_line::Program;

/// The exit statuses of the program, which are a contract for scripts.
enum Exit : int {
  ok = 0,
  bad_input = 1,  ///< the map is wrong
  bad_call = 2,   ///< the command line is wrong
  failed = 3,     ///< the network or the device failed
};

/// Writes "coupler COMMAND: error: WHAT; REMEDY" to standard error and returns `exit`. `remedy` is empty if
/// `what` already contains it.
inline Exit complain(std::string_view command, Exit exit, std::string_view what, std::string_view remedy) {
  const std::string line = fmt::format("coupler {}: error: {}{}{}\n", command, printable_lines(what),
                                       remedy.empty() ? "" : "; ", printable_lines(remedy));
  std::fputs(line.c_str(), stderr);
  return exit;
}

/// Why a command cannot go on: how it ends, what is wrong, and what to do.
struct Failure {
  Exit exit;
  std::string what;
  std::string remedy;
};

inline tl::unexpected<Failure> fail(Exit exit, std::string what, std::string remedy) {
  return tl::make_unexpected(Failure{exit, std::move(what), std::move(remedy)});
}

inline Exit complain(std::string_view command, const Failure& why) {
  return complain(command, why.exit, why.what, why.remedy);
}

/// Writes all of the text to standard output, including any NUL in it. main() checks whether that succeeded.
inline void put(std::string_view text) { std::fwrite(text.data(), 1, text.size(), stdout); }

void add_certificates(Program& program, Exit& exit);
void add_check(Program& program, Exit& exit);
void add_diff(Program& program, Exit& exit);
void add_dump(Program& program, Exit& exit);
void add_export(Program& program, Exit& exit);
void add_fetch(Program& program, Exit& exit);
void add_generate(Program& program, Exit& exit);
void add_import(Program& program, Exit& exit);
void add_init(Program& program, Exit& exit);
void add_panel(Program& program, Exit& exit);
void add_pin(Program& program, Exit& exit);
void add_plan(Program& program, Exit& exit);
void add_probe(Program& program, Exit& exit);
void add_record(Program& program, Exit& exit);
void add_schema(Program& program, Exit& exit);
void add_status(Program& program, Exit& exit);

}  // namespace coupler::tools
