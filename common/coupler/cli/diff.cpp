// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <memory>
#include <string>

#include "coupler/cli/commands.hpp"
#include "coupler/cli/diff_report.hpp"
#include "coupler/cli/map_argument.hpp"
#include "coupler/cli/report.hpp"

namespace coupler::cli {
namespace {

using changes::Severity;

struct Arguments {
  Versions versions;
  std::string format = "text";
  std::string fail_on = "breaking";
};

/// Of one of the three names.
Severity severity_of(const std::string& name) {
  for (const Severity severity : {Severity::breaking, Severity::compatible})
    if (to_string(severity) == name) return severity;
  return Severity::documentation;
}

Exit run(const Arguments& arguments) {
  const MapArgument older = get_version(arguments.versions.older);
  print(older.loaded.diagnostics);
  const MapArgument newer = get_version(arguments.versions.newer);
  print(newer.loaded.diagnostics);
  if (!older.loaded.map) return older.exit;
  if (!newer.loaded.map) return newer.exit;
  const auto changes = changes::compare(older.loaded.map->map(), newer.loaded.map->map());
  const auto report = arguments.format == "json"       ? diff_json
                      : arguments.format == "markdown" ? diff_markdown
                                                       : diff_text;
  std::fputs(report(arguments.versions, changes).c_str(), stdout);
  const auto worst = changes::worst(changes);
  return worst && *worst <= severity_of(arguments.fail_on) ? bad_input : ok;
}

}  // namespace

void add_diff(Program& program, Exit& exit) {
  auto command = program.add_command("diff", "Say what a new version of a map means for its users.");
  const auto arguments = std::make_shared<Arguments>();
  command
      .add_option("OLD", arguments->versions.older,
                  "A file, REVISION:PATH of git, or tcp://HOST[:PORT][/UNIT]")
      .required()
      .type_name("");
  command.add_option("NEW", arguments->versions.newer, "The same").required().type_name("");
  command.add_option("--format", arguments->format, "text (default), json or markdown")
      .one_of({"text", "json", "markdown"})
      .type_name("FORMAT");
  command
      .add_option("--fail-on", arguments->fail_on,
                  "Exit with 1 for this class or a worse one: breaking (default), compatible, documentation")
      .one_of({"breaking", "compatible", "documentation"})
      .type_name("CLASS");
  command.footer(
      "Example:\n  coupler diff main:config/cell.yaml config/cell.yaml\n  coupler diff cell.yaml "
      "tcp://raspberrypi\n"
      "A change is breaking exactly when a driver with the old map would refuse a node with the new one.");
  command.callback([arguments, &exit] { exit = run(*arguments); });
}

}  // namespace coupler::cli
