// SPDX-License-Identifier: Apache-2.0
#include "coupler/tools/formats/importers.hpp"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <tl/expected.hpp>

#include "coupler/generate/output.hpp"
#include "coupler/map/loader/source_text.hpp"
#include "coupler/tools/commands.hpp"
#include "coupler/tools/output_argument.hpp"
#include "coupler/tools/report.hpp"

namespace coupler::tools {
namespace {

namespace fs = std::filesystem;

struct Arguments {
  std::string format;
  std::string file;
  std::string out;
  formats::ImportOptions options;
  std::string addressing = "zero_based";
  std::vector<std::string> columns;
  unsigned unit = 0;
  bool force = false;
  bool list = false;
};

std::string names_of_formats() {
  std::string names;
  for (const formats::Importer& importer : formats::importers())
    names += fmt::format("{}{}", names.empty() ? "" : ", ", importer.name);
  return names;
}

/// At most one byte more than a map may have, which the loader then refuses.
tl::expected<std::string, std::string> read(std::istream& in) {
  std::string text(loader::max_text_size + 1, '\0');
  try {
    in.read(text.data(), static_cast<std::streamsize>(text.size()));
  } catch (const std::exception&) {  // a folder: libstdc++'s buffer throws on a failed read
    return tl::unexpected<std::string>(std::strerror(EISDIR));
  }
  if (in.bad()) return tl::unexpected<std::string>(std::strerror(errno != 0 ? errno : EIO));
  text.resize(static_cast<std::size_t>(in.gcount()));
  return text;
}

tl::expected<std::string, std::string> read_file(const std::string& path) {
  if (path == "-") return read(std::cin);
  errno = 0;
  std::ifstream in(path, std::ios::binary);
  if (!in) return tl::unexpected<std::string>(std::strerror(errno));
  return read(in);
}

/// "plant.yaml" for unit 3 of several: "plant_3.yaml".
fs::path path_of(const std::string& out, const formats::ImportedMap& map, bool several) {
  fs::path path(out);
  if (several && map.unit)
    path.replace_filename(fmt::format("{}_{}{}", path.stem().string(), *map.unit, path.extension().string()));
  return path;
}

/// A map that somebody may have worked on. What is the same may be written again.
bool holds_other_text(const fs::path& path, const std::string& text) {
  if (!fs::exists(path)) return false;
  const auto found = read_file(path.string());
  return !found || *found != text;
}

/// Takes one column's heading up to the next comma; in quotes, it may have commas.
std::string take_heading(std::string_view& text) {
  const bool is_quoted = text.substr(0, 1) == "\"" && text.find('"', 1) != std::string_view::npos;
  if (is_quoted) text.remove_prefix(1);
  const std::size_t end = std::min(text.find(is_quoted ? '"' : ','), text.size());
  std::string heading(text.substr(0, end));
  text.remove_prefix(end + (is_quoted ? 1 : 0));
  return heading;
}

/// "name=Tag no.,address=Reg" for --columns; false if it is not of that form.
bool parse_columns(std::string_view text, std::vector<formats::ColumnNames>& columns) {
  while (!text.empty()) {
    const std::size_t equals = text.find('=');
    if (equals == std::string_view::npos || equals == 0) return false;
    std::string column(text.substr(0, equals));
    text.remove_prefix(equals + 1);
    columns.push_back({std::move(column), take_heading(text)});
    if (columns.back().heading.empty() || (!text.empty() && text[0] != ',')) return false;
    text.remove_prefix(std::min<std::size_t>(text.size(), 1));
  }
  return true;
}

Exit write(const Arguments& arguments, const formats::ImportResult& result) {
  const bool several = result.maps.size() > 1;
  if (several && names_no_file(arguments.out)) {
    std::string units;
    for (const formats::ImportedMap& map : result.maps)
      units += fmt::format("{}{}", units.empty() ? "" : ", ", map.unit.value_or(0));
    return complain("import", bad_call, fmt::format("{} has several units: {}", arguments.file, units),
                    "choose one with --unit, or write a map for each with --out");
  }
  if (names_no_file(arguments.out)) return write_out("import", arguments.out, result.maps.front().text);
  for (const formats::ImportedMap& imported : result.maps) {
    const fs::path path = path_of(arguments.out, imported, several);
    if (!arguments.force && holds_other_text(path, imported.text))
      return complain("import", bad_call, fmt::format("{} is already there", path.string()),
                      "name another file with --out, or replace it with --force");
    if (const auto outcome = generate::write_if_changed(path, imported.text); !outcome)
      return complain("import", bad_call, outcome.error(), "give a file that you may write with --out");
    std::puts(summary(path.string(), imported.map->map()).c_str());
  }
  return ok;
}

Exit run(const Arguments& arguments) {
  if (arguments.list) {
    for (const formats::Importer& importer : formats::importers())
      fmt::print("{:<14}  {}\n", importer.name, importer.summary);
    return ok;
  }
  if (arguments.file.empty())
    return complain("import", bad_call, "FORMAT and FILE are required", "see `coupler import --help`");
  const formats::Importer* importer = formats::find_importer(arguments.format);
  if (importer == nullptr)
    return complain("import", bad_call,
                    fmt::format("'{}' is not a format that can be read", arguments.format),
                    "give one of " + names_of_formats());
  formats::ImportOptions options = arguments.options;
  options.addressing = parse_word<loader::Addressing>(arguments.addressing).value_or(options.addressing);
  for (const std::string& columns : arguments.columns)
    if (!parse_columns(columns, options.columns))
      return complain("import", bad_call, fmt::format("--columns '{}' is not a list of columns", columns),
                      "write it as in --columns 'name=Tag no.,address=Reg'; a heading with a comma stands in "
                      "quotes, as in --columns 'scale=\"Gain, SF\"'");
  const bool has_table_options = !arguments.columns.empty() || arguments.addressing != "zero_based" ||
                                 !options.order.empty() || !options.strings.empty();
  if (!importer->is_table && has_table_options)
    return complain("import", bad_call, "--columns, --addressing, --order and --strings are for tables",
                    fmt::format("leave them out: '{}' says all that itself", importer->name));
  if (!importer->has_devices && !options.device.empty())
    return complain(
        "import", bad_call, "--device is for files that may have several",
        fmt::format("leave it out: a file of '{}' has one, or units; see --unit", importer->name));
  const std::string file = arguments.file == "-" ? "<stdin>" : arguments.file;
  const auto text = read_file(arguments.file);
  if (!text) {
    fmt::print(stderr, "{}: error: the file cannot be read: {}; give the path of a file that you may read\n",
               file, text.error());
    return bad_input;
  }
  const formats::ImportResult result = formats::import_text(*importer, *text, file, options);
  print(result.diagnostics);
  return result.maps.empty() ? bad_input : write(arguments, result);
}

}  // namespace

void add_import(Program& program, Exit& exit) {
  auto command = program.add_command("import", "Make a map from another program's file.");
  const auto arguments = std::make_shared<Arguments>();
  command.add_option("FORMAT", arguments->format, "Format of the file: see --list").type_name("");
  command.add_option("FILE", arguments->file, "The file; - is standard input").type_name("");
  command
      .add_option(
          "--out", arguments->out,
          "Where to write the map; default, and -: standard output. If the file has several units, each "
          "gets a map: MAP_1.yaml ...")
      .type_name("MAP");
  command.add_option("--name", arguments->options.name, "Name of the map; default: the file's")
      .type_name("NAME");
  auto unit = command.add_option("--unit", arguments->unit, "Only this unit of the file")
                  .in_range(0, 255)
                  .type_name("N");
  command
      .add_option("--device", arguments->options.device,
                  "Only this one of several: a device of pymodbus' simulator, a hub of Home Assistant")
      .type_name("NAME");
  command
      .add_option(
          "--addressing", arguments->addressing,
          "What the addresses of a table count: zero_based (default) or modicon, where 40001 is the first "
          "holding register and no column 'table' is needed")
      .one_of({"zero_based", "modicon"})
      .type_name("KIND");
  command
      .add_option(
          "--columns", arguments->columns,
          "Headings of a table that are not understood, or have two meanings: name=Tag,address=Reg; may be "
          "given several times; "
          "scale=Gain (a factor) or divisor=Gain, scaled_units=Unit (0.1V scales) or units=Unit (it "
          "is the name of the units), scale_offset=Offset or address_offset=Offset, ignore=Range (left out)")
      .one_value()
      .type_name("LIST");
  command
      .add_option("--order", arguments->options.order,
                  "Order of a table's values of several registers that have none: ABCD is the most "
                  "significant register first, CDAB the least significant")
      .one_of({"ABCD", "CDAB", "BADC", "DCBA"})
      .type_name("ORDER");
  command
      .add_option("--strings", arguments->options.strings,
                  "What the number in a table's type string[6] counts: characters, or registers")
      .one_of({"characters", "registers"})
      .type_name("WHAT");
  command.add_flag("--force", arguments->force, "Replace a map that is there with --out");
  command.add_flag("--list", arguments->list, "Print the formats");
  command.footer(
      "Example:\n  coupler import csv points.csv --name press --out press.yaml\n"
      "Warnings on standard error say what was changed and what could not be carried over, with its place in "
      "the file.");
  command.callback([arguments, unit, &exit] {
    if (unit.given()) arguments->options.unit = arguments->unit;
    exit = run(*arguments);
  });
}

}  // namespace coupler::tools
