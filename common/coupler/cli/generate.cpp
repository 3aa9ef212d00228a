// SPDX-License-Identifier: Apache-2.0
#include "coupler/generate/generate.hpp"

#include <filesystem>
#include <memory>
#include <string>
#include <system_error>
#include <vector>

#include <fmt/format.h>

#include "coupler/cli/commands.hpp"
#include "coupler/cli/complain.hpp"
#include "coupler/cli/locked_map.hpp"
#include "coupler/cli/map_argument.hpp"
#include "coupler/cli/map_pages.hpp"
#include "coupler/cli/report.hpp"
#include "coupler/generate/code.hpp"
#include "coupler/generate/output.hpp"
#include "coupler/test_vectors/json.hpp"

namespace coupler::cli {
namespace {

namespace fs = std::filesystem;

struct Arguments {
  std::string map;
  std::string out;
  std::string name;
  std::string source_url;
  bool docs = false;
  bool vectors = false;
  bool quiet = false;
  bool locked = false;
};

fs::path folder_of(const Arguments& arguments) { return arguments.out.empty() ? "." : arguments.out; }

Exit write(const Arguments& arguments, const std::vector<generate::File>& files) {
  constexpr auto remedy = "give a folder that you may write to with --out";
  std::error_code failed;
  fs::create_directories(folder_of(arguments), failed);
  if (failed)
    return complain("generate", bad_call,
                    fmt::format("cannot make the folder {}: {}", arguments.out, failed.message()), remedy);
  for (const generate::File& file : files) {
    const fs::path path = (folder_of(arguments) / file.name).lexically_normal();
    const auto outcome = generate::write_if_changed(path, file.content);
    if (!outcome) return complain("generate", bad_call, outcome.error(), remedy);
    if (!arguments.quiet)
      fmt::print("{}: {}\n", path.string(), *outcome == generate::Outcome::written ? "written" : "unchanged");
  }
  return ok;
}

Exit run(const Arguments& arguments) {
  if (!is_url_part(arguments.source_url))
    return complain("generate", bad_call, fmt::format("'{}' is not part of a URL", arguments.source_url),
                    "write what a URL cannot hold as %XX");
  const MapArgument argument = get_map(arguments.map, arguments.locked ? LockUse::exact : LockUse::renew);
  const LoadResult& loaded = argument.loaded;
  print(loaded.diagnostics);
  std::fputs(lock_report(loaded.lock).c_str(), stdout);
  if (!loaded.map) return argument.exit;
  const std::string source =
      arguments.map == "-" ? "standard input" : fs::path(arguments.map).filename().string();
  const Map map = argument.map();
  const std::string name = arguments.name.empty() ? std::string(map.name) : arguments.name;
  if (arguments.docs)
    return write(arguments,
                 map_pages({arguments.map, folder_of(arguments), name, source, arguments.source_url}, map,
                           loaded.point_lines));
  if (arguments.vectors)
    return write(arguments,
                 {{as_file_name(name) + "_vectors.json", test_vectors::json(map, source, COUPLER_VERSION)}});
  const generate::Provenance provenance{name, source, COUPLER_VERSION};
  if (generate::is_identifier(provenance.name)) return write(arguments, generate::generate(map, provenance));
  const auto remedy = "give one with --name: letters, digits and underscores, a letter first, no word of C++";
  if (!arguments.name.empty())
    return complain("generate", bad_call, fmt::format("'{}' cannot name C++ code", provenance.name), remedy);
  return complain("generate", bad_input,
                  fmt::format("the map's name '{}' cannot name C++ code", provenance.name), remedy);
}

}  // namespace

void add_generate(Program& program, Exit& exit) {
  auto command = program.add_command(
      "generate",
      "Make C++ from a map: a constant table, a node, a driver, a typed client, hooks for a firmware.");
  const auto arguments = std::make_shared<Arguments>();
  command.add_option("MAP", arguments->map, map_help).required().type_name("");
  auto out =
      command
          .add_option(
              "--out", arguments->out,
              "Folder for the files; made if it is not there. With --docs and --vectors, if not given: "
              "this one")
          .type_name("DIR");
  command
      .add_option("--name", arguments->name,
                  "What the files and the C++ namespace are called; default: the map's name")
      .type_name("NAME");
  auto docs = command.add_flag("--docs", arguments->docs,
                               "Instead: NAME.md and NAME.html, the register map for people");
  command
      .add_option("--source-url", arguments->source_url,
                  "With --docs: where the map is on a forge; links go to this, its name and #L12")
      .needs(docs)
      .type_name("PREFIX");
  command
      .add_flag("--vectors", arguments->vectors,
                "Instead: NAME_vectors.json, values of every point and how they stand on the wire")
      .excludes(docs);
  command.add_flag("--locked", arguments->locked,
                   "Do not write the map's lock; one that is missing or not up to date is an error");
  command.add_flag("--quiet", arguments->quiet, "Say nothing of files when all is well");
  command.footer(
      "Example:\n  coupler generate device.yaml --out generated\n"
      "makes device_map.hpp and .cpp, device_client.hpp and .cpp, device_hooks.hpp, device_node.cpp and "
      "device_driver.cpp. Files that would not change are not touched.\n"
      "  coupler generate device.yaml --docs\nmakes device.md and device.html.\n"
      "  coupler generate device.yaml --vectors\nmakes device_vectors.json.\n"
      "In a CMake build, coupler_add_map(device device.yaml) does this and builds the "
      "programs.");
  command.callback([arguments, out, &exit] {
    if (!out.given() && !arguments->docs && !arguments->vectors) out.refuse_missing();
    exit = run(*arguments);
  });
}

}  // namespace coupler::cli
