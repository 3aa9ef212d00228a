// SPDX-License-Identifier: Apache-2.0
#include "coupler/tools/schema/schema.hpp"

#include <memory>
#include <string>

#include "coupler/tools/commands.hpp"
#include "coupler/tools/output_argument.hpp"

namespace coupler::tools {
namespace {

Exit run(const std::string& out) {
  if (!names_no_file(out) && has_none_of(out, {"json-schema.org/"}))
    return complain("schema", bad_call, out + " is there, and it is no JSON Schema",
                    "name another file with --out, or remove it");
  return write_out("schema", out, schema::map_schema());
}

}  // namespace

void add_schema(Program& program, Exit& exit) {
  auto command = program.add_command(
      "schema", "Print the JSON Schema of maps: editors check, complete and explain keys with it.");
  const auto out = std::make_shared<std::string>();
  command
      .add_option("--out", *out,
                  "Write it to a file, which is not touched if it holds it already; - is standard output")
      .type_name("FILE");
  command.footer(
      "Example:\n  coupler schema --out map.schema.json\n"
      "and as the first line of a map beside it: # yaml-language-server: $schema=map.schema.json");
  command.callback([out, &exit] { exit = run(*out); });
}

}  // namespace coupler::tools
