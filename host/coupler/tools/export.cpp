// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <string>

#include <fmt/format.h>

#include "coupler/tools/commands.hpp"
#include "coupler/tools/formats/exporters.hpp"
#include "coupler/tools/map_argument.hpp"
#include "coupler/tools/output_argument.hpp"

namespace coupler::tools {
namespace {

struct Arguments {
  std::string map;
  TlsTexts tls;
  std::string to;
  std::string out;
  bool node_statistics = false;
  bool list = false;
};

std::string names_of_formats() {
  std::string names;
  for (const formats::Exporter& exporter : formats::exporters())
    names += fmt::format("{}{}", names.empty() ? "" : ", ", exporter.name);
  return names;
}

Exit run(const Arguments& arguments) {
  if (arguments.list) {
    for (const formats::Exporter& exporter : formats::exporters())
      fmt::print("{:<15}  {}\n", exporter.name, exporter.summary);
    return ok;
  }
  if (arguments.map.empty() || arguments.to.empty())
    return complain("export", bad_call, "MAP and --to FORMAT are required", "see `coupler export --help`");
  const formats::Exporter* exporter = formats::find_exporter(arguments.to);
  if (exporter == nullptr)
    return complain("export", bad_call, fmt::format("'{}' is not a format that can be written", arguments.to),
                    "give one of " + names_of_formats());
  if (arguments.node_statistics && exporter->write_with_statistics == nullptr)
    return complain("export", bad_call,
                    fmt::format("--node-statistics has no meaning for '{}'", exporter->name),
                    "leave it out, or write --to telegraf");
  const MapArgument argument = get_map(arguments.map, arguments.tls);
  print(argument.loaded.diagnostics);
  if (!argument.loaded.map) return argument.exit;
  if (exporter->is_for_client && !formats::lets_read_without_tls(argument.map()))
    return complain(
        "export", bad_input,
        fmt::format(
            "'security' lets no client without TLS read anything, and '{}' is for a program that has no "
            "TLS",
            exporter->name),
        "give such clients a role that may read, as in `security: {roles: {viewer: {read: all}}, plain: "
        "viewer}`");
  const formats::Export exported = arguments.node_statistics ? exporter->write_with_statistics(argument.map())
                                                             : exporter->write(argument.map());
  print(exported.warnings.diagnostics(arguments.map));
  if (names_no_file(arguments.out)) return write_out("export", arguments.out, exported.text);
  return write_beside_map("export", arguments.map, "--out", arguments.out, exported.text);
}

}  // namespace

void add_export(Program& program, Exit& exit) {
  auto command = program.add_command("export", "Write a map as a file of another program.");
  const auto arguments = std::make_shared<Arguments>();
  command.add_option("MAP", arguments->map, map_help).type_name("");
  command.add_option("--to", arguments->to, "What to write: see --list").type_name("FORMAT");
  command.add_option("--out", arguments->out, "Where to write it; default, and -: standard output")
      .type_name("FILE");
  command.add_flag("--node-statistics", arguments->node_statistics,
                   "With --to telegraf, for a map that coupler-node serves: its statistics, too");
  command.add_flag("--list", arguments->list, "Print the formats");
  add_tls_options(command, arguments->tls);
  command.footer(
      "Example:\n  coupler export device.yaml --to csv --out device.csv\n  coupler export raspberrypi --to "
      "csv\n"
      "Warnings on standard error say what the format cannot express.");
  command.callback([arguments, &exit] { exit = run(*arguments); });
}

}  // namespace coupler::tools
