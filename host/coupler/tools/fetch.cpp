// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <string>

#include "coupler/tools/commands.hpp"
#include "coupler/tools/live_map.hpp"
#include "coupler/tools/output_argument.hpp"
#include "coupler/tools/place_argument.hpp"
#include "coupler/tools/save_map.hpp"

namespace coupler::tools {
namespace {

struct Arguments {
  std::string host;
  TlsTexts tls;
  std::string out;
  bool force = false;
};

Exit run(const Arguments& arguments) {
  const auto place = get_place(arguments.host, arguments.tls);
  if (!place) return complain("fetch", place.error());
  if (const auto can = can_make(arguments.out, arguments.force); !can) return complain("fetch", can.error());
  const auto map = fetch_live_map(place->connection);
  if (!map)
    return complain("fetch", map.error().exit, node_address_text(place->connection) + ": " + map.error().what,
                    map.error().remedy);
  return save_map("fetch", arguments.out, (*map)->map(), place->connection);
}

}  // namespace

void add_fetch(Program& program, Exit& exit) {
  auto command = program.add_command(
      "fetch", "Save the map that a node serves, byte for byte. It never writes to the node.");
  const auto arguments = std::make_shared<Arguments>();
  command.add_option("HOST", arguments->host, place_help).required().type_name("");
  command.add_option("-o,--out", arguments->out, "Where to write it; default, and -: standard output")
      .type_name("FILE");
  command.add_flag("--force", arguments->force, "Replace an existing file");
  add_tls_options(command, arguments->tls);
  command.footer(
      "Example:\n  coupler fetch raspberrypi -o cell.yaml\n  coupler fetch 10.0.0.7:1502 | less\n"
      "Exit status 1: a foreign coupler, which serves no map; 3: no answer.");
  command.callback([arguments, &exit] { exit = run(*arguments); });
}

}  // namespace coupler::tools
