// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "coupler/tools/certificate_check.hpp"
#include "coupler/tools/commands.hpp"
#include "coupler/tools/map_argument.hpp"
#include "coupler/tools/report.hpp"

namespace coupler::tools {
namespace {

struct Arguments {
  TlsTexts tls;
  std::vector<std::string> maps;
  bool json = false;
  bool locked = false;
};

/// Checks the certificates of a map and returns lines about them for people. If there are problems, they
/// become diagnostics, and the map counts as one that does not load.
std::vector<std::string> take_certificates(const std::string& file, MapArgument& argument) {
  LoadResult& loaded = argument.loaded;
  if (!loaded.map) return {};
  CertificateFindings findings = check_certificates(loaded.map->map());
  for (const std::string& problem : findings.problems) {
    const std::size_t end = problem.find("; ");
    loaded.diagnostics.push_back(
        {Diagnostic::Severity::error, file, 0, 0, problem.substr(0, end),
         end == std::string::npos ? "docs/security.md has the recipe" : problem.substr(end + 2)});
  }
  if (!findings.problems.empty()) {
    loaded.map = nullptr;
    argument.exit = bad_input;
  }
  return findings.lines;
}

Exit check(const Arguments& arguments) {
  Exit exit = ok;
  for (const std::string& file : arguments.maps) {
    MapArgument argument = get_map(file, arguments.tls, arguments.locked ? LockUse::exact : LockUse::renew);
    const std::vector<std::string> certificates = take_certificates(file, argument);
    const LoadResult& loaded = argument.loaded;
    exit = std::max(exit, argument.exit);
    if (arguments.json) {
      std::puts(json_report(file, loaded).c_str());
    } else {
      print(loaded.diagnostics);
      put(lock_report(loaded.lock));
      if (!loaded.map) continue;
      std::puts(summary(file, loaded.map->map()).c_str());
      put(moveit_margin(loaded.map->map()));
      put(rights_table(loaded.map->map()));
      for (const std::string& line : certificates) std::puts(line.c_str());
    }
  }
  return exit;
}

}  // namespace

void add_check(Program& program, Exit& exit) {
  auto command =
      program.add_command("check", "Say what is wrong with a map, where, and what to do about it.");
  const auto arguments = std::make_shared<Arguments>();
  command.add_option("MAP", arguments->maps, map_help).required().type_name("");
  command.add_flag("--json", arguments->json,
                   "One JSON object per map on standard output, for editors and scripts");
  command.add_flag("--locked", arguments->locked,
                   "Write nothing; a lock that is missing or not up to date is an error. For CI");
  add_tls_options(command, arguments->tls);
  command.footer(
      "Example:\n  coupler check device.yaml\n  coupler check raspberrypi\nPoints without an address get "
      "one, which is kept in "
      "device.yaml.lock beside the map.\nExit status 0: every map is valid; 1: at least one is not.");
  command.callback([arguments, &exit] { exit = check(*arguments); });
}

}  // namespace coupler::tools
