// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

#include <fmt/format.h>

#include "coupler/cli/commands.hpp"
#include "coupler/cli/report.hpp"
#include "coupler/cli/starter_map.hpp"
#include "coupler/generate/output.hpp"
#include "coupler/map/loader/load.hpp"
#include "coupler/schema/schema.hpp"

namespace coupler::cli {
namespace {

constexpr auto schema_name = "map.schema.json";

struct Arguments {
  Starter starter{"device", "192.168.1.17", {}, false, schema_name};
  std::string out;
  bool force = false;
};

Exit refuse(const std::string& what, Exit exit) {
  fmt::print(stderr, "coupler init: error: {}\n", what);
  return exit;
}

Exit init(const Arguments& arguments) {
  const std::filesystem::path map = arguments.out.empty() ? arguments.starter.name + ".yaml" : arguments.out;
  if (!arguments.force && std::filesystem::exists(map))
    return refuse(fmt::format("{} is there already; name another file with --out, or replace it with --force",
                              map.string()),
                  bad_call);
  const std::string text = starter_map(arguments.starter);
  const LoadResult loaded = load_map(text, map.string());
  if (!loaded.map) {  // the name, the address or the preset
    print(loaded.diagnostics);
    return bad_input;
  }
  for (const auto& [path, content] :
       {std::pair(map, text), std::pair(map.parent_path() / schema_name, schema::map_schema())}) {
    const auto outcome = generate::write_if_changed(path, content);
    if (!outcome) return refuse(outcome.error() + "; name a file that you may write with --out", bad_call);
    fmt::print("{}: {}\n", path.string(), *outcome == generate::Outcome::written ? "written" : "unchanged");
  }
  fmt::print("Next: change its points, then `coupler check {}`\n", map.string());
  return ok;
}

}  // namespace

void add_init(Program& program, Exit& exit) {
  auto command = program.add_command(
      "init", "Write a first map, with comments, and beside it the schema that editors check it with.");
  const auto arguments = std::make_shared<Arguments>();
  command.add_option("NAME", arguments->starter.name, "Of the device: its topics are NAME/POINT")
      .type_name("");
  auto address = command.add_option("--address", arguments->starter.address, "Host name or IP address")
                     .type_name("HOST");
  auto preset = command
                    .add_option("--preset", arguments->starter.preset,
                                "The coupler's kind: wago_750, beckhoff_bk9000, moxa_e1200 or plc")
                    .type_name("PRESET");
  command.add_flag("--node", arguments->starter.node, "For a board with GPIO lines, served by coupler-node")
      .excludes(address)
      .excludes(preset);
  command.add_option("--out", arguments->out, "The map's file (default: NAME.yaml)").type_name("FILE");
  command.add_flag("--force", arguments->force, "Replace a map that is there");
  command.footer(
      "Example:\n  coupler init press --preset wago_750 --address 192.168.1.17\n  coupler init cell --node");
  command.callback([arguments, &exit] { exit = init(*arguments); });
}

}  // namespace coupler::cli
