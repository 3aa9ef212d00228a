// SPDX-License-Identifier: Apache-2.0
#include "coupler/schema/schema.hpp"

#include <cstdio>
#include <memory>
#include <string>

#include "coupler/cli/commands.hpp"
#include "coupler/generate/output.hpp"

namespace coupler::cli {
namespace {

Exit run(const std::string& out) {
  const std::string text = schema::map_schema();
  if (out.empty()) {
    std::fputs(text.c_str(), stdout);
    return ok;
  }
  const auto outcome = generate::write_if_changed(out, text);
  if (outcome) return ok;
  return complain("schema", bad_call, outcome.error(), "name a file that you may write with --out");
}

}  // namespace

void add_schema(Program& program, Exit& exit) {
  auto command = program.add_command(
      "schema", "Print the JSON Schema of maps: editors check, complete and explain keys with it.");
  const auto out = std::make_shared<std::string>();
  command.add_option("--out", *out, "Write it to a file; one that holds it already is not touched")
      .type_name("FILE");
  command.footer(
      "Example:\n  coupler schema --out map.schema.json\n"
      "and as the first line of a map beside it: # yaml-language-server: $schema=map.schema.json");
  command.callback([out, &exit] { exit = run(*out); });
}

}  // namespace coupler::cli
