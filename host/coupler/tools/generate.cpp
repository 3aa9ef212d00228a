// SPDX-License-Identifier: Apache-2.0
#include "coupler/generate/generate.hpp"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include <fmt/format.h>

#include "coupler/docs/document.hpp"
#include "coupler/generate/code.hpp"
#include "coupler/generate/output.hpp"
#include "coupler/generate/python.hpp"
#include "coupler/map/escape.hpp"
#include "coupler/map/loader/document.hpp"
#include "coupler/map/loader/problems.hpp"
#include "coupler/test_vectors/json.hpp"
#include "coupler/tools/commands.hpp"
#include "coupler/tools/map_argument.hpp"
#include "coupler/tools/output_argument.hpp"
#include "coupler/tools/report.hpp"

namespace coupler::tools {
namespace {

namespace fs = std::filesystem;

struct Arguments {
  std::string map;
  TlsTexts tls;
  std::string out;
  std::string name;
  std::string source_url;
  bool docs = false;
  bool vectors = false;
  bool python = false;
  bool quiet = false;
  bool locked = false;
  bool force = false;
};

fs::path folder_of(const Arguments& arguments) { return arguments.out.empty() ? "." : arguments.out; }

/// Without slashes: maps may be called hall/press.
std::string as_file_name(std::string name) {
  std::replace(name.begin(), name.end(), '/', '_');
  return name;
}

/// Nothing in it ends a URL in HTML or Markdown.
bool is_url_part(std::string_view text) {
  constexpr std::string_view refused = "<>\"\\^`{|}";
  return std::none_of(text.begin(), text.end(), [&](char c) {
    return (static_cast<unsigned char>(c) <= ' ') || refused.find(c) != std::string_view::npos;
  });
}

/// Returns the target of the links in the pages to a map's file: relative to their folder, or on a forge.
std::string url_of_map(const Arguments& arguments) {
  const fs::path map = fs::absolute(arguments.map).lexically_normal();
  if (arguments.source_url.empty())
    return url_path(map.lexically_relative(fs::absolute(folder_of(arguments)).lexically_normal()).string());
  const bool ended = arguments.source_url.back() == '/';
  return arguments.source_url + (ended ? "" : "/") + url_path(map.filename().string());
}

/// NAME.html and NAME.md. Only a file is linked to, and not standard input or a node.
std::vector<generate::File> map_pages(const Arguments& arguments, const std::string& name,
                                      const std::string& source, const Map& map,
                                      const MapArgument& argument) {
  const bool is_file = arguments.map != "-" && !argument.node;
  const docs::Provenance from{source, is_file ? url_of_map(arguments) : "", COUPLER_VERSION};
  const auto document = docs::make_document(map, argument.loaded.point_lines, from);
  const std::string file = as_file_name(name);
  return {{file + ".html", docs::html_page(document)}, {file + ".md", docs::markdown_page(document)}};
}

/// Returns whether somebody wrote the file by hand: every generated file says that coupler made it.
bool is_by_hand(const std::string& path) {
  return has_none_of(path, {"by coupler ", "\"made_by\": \"coupler "});
}

Exit write(const Arguments& arguments, const std::vector<generate::File>& files) {
  if (arguments.out == standard_output) return write_out("generate", arguments.out, files.front().content);
  constexpr auto remedy = "give a folder that you may write to with --out";
  std::error_code failed;
  fs::create_directories(folder_of(arguments), failed);
  if (failed)
    return complain("generate", bad_call,
                    fmt::format("cannot create the folder {}: {}", arguments.out, failed.message()), remedy);
  for (const generate::File& file : files) {
    const fs::path path = (folder_of(arguments) / file.name).lexically_normal();
    if (!arguments.force && is_by_hand(path.string()))
      return complain("generate", bad_call, fmt::format("{} was not made by coupler", path.string()),
                      "name another folder with --out, or replace it with --force");
    const auto outcome = generate::write_if_changed(path, file.content);
    if (!outcome) return complain("generate", bad_call, outcome.error(), remedy);
    if (!arguments.quiet)
      fmt::print("{}: {}\n", path.string(), *outcome == generate::Outcome::written ? "written" : "unchanged");
  }
  return ok;
}

Exit write_python(const Arguments& arguments, const generate::Provenance& provenance, const Map& map) {
  if (!generate::is_name(provenance.name))
    return complain("generate", bad_call, fmt::format("'{}' is not a valid name in Python", provenance.name),
                    "give another one with --name: letters, digits and underscores, beginning with a letter");
  if (map.connection.is_broadcast())
    return complain("generate", bad_input,
                    "the client in Python waits for answers, and unit 0 is a broadcast",
                    "write from C++, or give the map the unit of one coupler");
  return write(arguments, {{provenance.name + "_client.py", generate::python_client(map, provenance)}});
}

/// Returns the key of a node's map that would be lost, or an empty text. A map from a node is loaded without
/// `security` and `tls`. `tls` is not lost if the call gave TLS options, which replace it.
std::string_view lost_key(const MapArgument& argument) {
  loader::Problems ignored("");
  const auto root = loader::parse_document(argument.loaded.map->map().text, ignored);
  if (root && loader::child(*root, "security") != nullptr) return "security";
  if (root && loader::child(*root, "tls") != nullptr && !argument.tls.present()) return "tls";
  return {};
}

Exit run(const Arguments& arguments) {
  if (!is_url_part(arguments.source_url))
    return complain("generate", bad_call, fmt::format("'{}' cannot be part of a URL", arguments.source_url),
                    "write characters that a URL cannot hold as %XX");
  const bool to_folder = arguments.out != standard_output;
  if (!to_folder && !arguments.python && !arguments.vectors)
    return complain("generate", bad_call, "standard output cannot hold several files",
                    "name a folder with --out, or make a single file with --python or --vectors");
  const MapArgument argument =
      get_map(arguments.map, arguments.tls, arguments.locked ? LockUse::exact : LockUse::renew);
  const LoadResult& loaded = argument.loaded;
  print(loaded.diagnostics);
  std::fputs(lock_report(loaded.lock).c_str(), to_folder ? stdout : stderr);
  if (!loaded.map) return argument.exit;
  const std::string source = arguments.map == "-" ? "standard input"
                             : argument.node      ? arguments.map
                                                  : fs::path(arguments.map).filename().string();
  const std::string_view lost =
      argument.node && !arguments.python && !arguments.vectors ? lost_key(argument) : std::string_view();
  if (!lost.empty())
    return complain(
        "generate", bad_input,
        fmt::format("the node's map has '{}', and what is made from a node would be without it", lost),
        "give the file of its map");
  const Map map = argument.map();
  const std::string name = arguments.name.empty() ? std::string(map.name) : arguments.name;
  if (arguments.docs) return write(arguments, map_pages(arguments, name, source, map, argument));
  if (arguments.vectors)
    return write(arguments,
                 {{as_file_name(name) + "_vectors.json", test_vectors::json(map, source, COUPLER_VERSION)}});
  if (arguments.python) return write_python(arguments, {as_file_name(name), source, COUPLER_VERSION}, map);
  const generate::Provenance provenance{name, source, COUPLER_VERSION};
  if (generate::is_identifier(name)) return write(arguments, generate::generate(map, provenance));
  const auto remedy =
      "give another one with --name: letters, digits and underscores, beginning with a letter, and not a "
      "keyword of C++";
  const bool given = !arguments.name.empty();
  return complain("generate", given ? bad_call : bad_input,
                  fmt::format("{}'{}' is not a valid name in C++", given ? "" : "the map's name ", name),
                  remedy);
}

}  // namespace

void add_generate(Program& program, Exit& exit) {
  auto command = program.add_command(
      "generate",
      "Make C++ from a map: a constant table, a node, a driver, a typed client, hooks for a firmware; or a "
      "client in Python.");
  const auto arguments = std::make_shared<Arguments>();
  command.add_option("MAP", arguments->map, map_help).required().type_name("");
  auto out = command
                 .add_option("--out", arguments->out,
                             "Folder for the files, which is created if it does not exist; --docs, --python "
                             "and --vectors default to the current one. - is standard output, with --python "
                             "and --vectors")
                 .type_name("DIR");
  command
      .add_option("--name", arguments->name,
                  "Name of the files, of the C++ namespace and of the Python class; default: the map's name")
      .type_name("NAME");
  auto python = command.add_flag("--python", arguments->python,
                                 "In place of C++: NAME_client.py, a client in one file on top of pymodbus");
  auto docs = command
                  .add_flag("--docs", arguments->docs,
                            "In place of C++: NAME.md and NAME.html, the register map for people")
                  .excludes(python);
  command
      .add_option("--source-url", arguments->source_url,
                  "With --docs: the URL of the folder that the map is in; links go to PREFIX/MAP#L12")
      .needs(docs)
      .type_name("PREFIX");
  command
      .add_flag("--vectors", arguments->vectors,
                "In place of C++: NAME_vectors.json, values of every point with their registers or bits")
      .excludes(docs)
      .excludes(python);
  command.add_flag("--locked", arguments->locked,
                   "Do not write the map's lock; one that is missing or not up to date is an error");
  command.add_flag("--force", arguments->force, "Also replace files that coupler has not made");
  command.add_flag("--quiet", arguments->quiet, "Do not list the files");
  add_tls_options(command, arguments->tls);
  command.footer(
      "Example:\n  coupler generate device.yaml --out generated\n"
      "makes device_map.hpp and .cpp, device_client.hpp and .cpp, device_hooks.hpp, device_core.hpp, "
      "device_node.cpp and device_driver.cpp. Files that would not change are not touched.\n"
      "  coupler generate device.yaml --docs\nmakes device.md and device.html.\n"
      "  coupler generate device.yaml --python\nmakes device_client.py with the class DeviceClient; "
      "of the map of a node: coupler generate raspberrypi --python\n"
      "  coupler generate device.yaml --vectors\nmakes device_vectors.json.\n"
      "In a CMake build, coupler_add_map(device device.yaml) does this and builds the "
      "programs.");
  command.callback([arguments, out, &exit] {
    if (!out.given() && !arguments->docs && !arguments->python && !arguments->vectors) out.refuse_missing();
    exit = run(*arguments);
  });
}

}  // namespace coupler::tools
