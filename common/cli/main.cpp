// SPDX-License-Identifier: Apache-2.0
// coupler: what a person or a build does with maps at the command line.
#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <string>

#include "common/base/version.hpp"
#include "common/cli/commands.hpp"

namespace {

/// "coupler check: error: MAP is required; see `coupler check --help`"
std::string explain(const CLI::App* program, const CLI::Error& error) {
  std::string command = program->get_name();
  for (const auto* subcommand : program->get_subcommands()) command += ' ' + subcommand->get_name();
  return command + ": error: " + error.what() + "; see `" + command + " --help`\n";
}

/// Of an unknown command CLI11 would only say that one is required.
void refuse_unknown_command(const CLI::App& program, int argc, char** argv) {
  const std::string first = argc > 1 ? argv[1] : "-";
  const auto is_named = [&first](const CLI::App* command) { return command->get_name() == first; };
  if (first[0] != '-' && program.get_subcommands(is_named).empty())
    throw CLI::ParseError("'" + first + "' is not a command", CLI::ExitCodes::ExtrasError);
}

}  // namespace

static_assert(coupler::version == COUPLER_VERSION, "common/base/version.hpp and CMakeLists.txt differ");

int main(int argc, char** argv) {
  CLI::App program{"OpenCoupler: makes both sides of a Modbus/TCP coupler from one map.", "coupler"};
  program.set_version_flag("--version", "coupler " COUPLER_VERSION);
  program.footer(
      "Example:\n  coupler check device.yaml\n`coupler COMMAND --help` tells more of one command.");
  program.require_subcommand(1);
  program.failure_message(explain);

  auto exit = coupler::cli::ok;
  coupler::cli::add_check(program, exit);
  coupler::cli::add_diff(program, exit);
  coupler::cli::add_dump(program, exit);
  coupler::cli::add_export(program, exit);
  coupler::cli::add_generate(program, exit);
  coupler::cli::add_import(program, exit);
  coupler::cli::add_init(program, exit);
  coupler::cli::add_plan(program, exit);
  coupler::cli::add_probe(program, exit);
  coupler::cli::add_schema(program, exit);
  try {
    refuse_unknown_command(program, argc, argv);
    program.parse(argc, argv);
  } catch (const CLI::ParseError& stopped) {  // --help and --version stop here too, with 0
    return program.exit(stopped) == 0 ? coupler::cli::ok : coupler::cli::bad_call;
  }
  return exit;
}
