// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "coupler/json/json_text.hpp"
#include "coupler/map/diagnostic.hpp"
#include "coupler/map/escape.hpp"
#include "coupler/map/printable.hpp"
#include "coupler/tools/commands.hpp"
#include "coupler/tools/map_argument.hpp"
#include "coupler/tools/map_changes.hpp"

namespace coupler::tools {
namespace {

using nlohmann::ordered_json;

/// The two maps as the user named them.
struct Versions {
  std::string older;
  std::string newer;
};

constexpr std::array severities{Severity::breaking, Severity::meaning, Severity::compatible,
                                Severity::documentation};

std::ptrdiff_t count(const std::vector<Change>& changes, Severity severity) {
  return std::count_if(changes.begin(), changes.end(),
                       [severity](const Change& change) { return change.severity == severity; });
}

std::string counts(const std::vector<Change>& changes) {
  if (changes.empty()) return "no difference";
  std::string text;
  for (const Severity severity : severities)
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count(changes, severity), to_string(severity));
  return text;
}

/// "5 -> 7", "none -> GPIO17".
std::string from_to(const Change& change) {
  const auto shown = [](const std::string& value) -> std::string_view {
    return value.empty() ? "none" : std::string_view(value);
  };
  return fmt::format("{} -> {}", shown(change.older), shown(change.newer));
}

std::string what(const Change& change) {
  if (change.rule == "point-removed" || change.rule == "tool-removed") return change.older;
  return change.rule == "point-added" || change.rule == "tool-added" ? change.newer : from_to(change);
}

std::string_view or_map(const Change& change) {
  return change.point.empty() ? std::string_view("(map)") : change.point;
}

/// A line for each change, the worst severity first, and one that counts them.
std::string diff_text(const Versions& versions, const std::vector<Change>& changes) {
  std::string text;
  for (const Severity severity : severities)
    for (const Change& change : changes)
      if (change.severity == severity)
        text += fmt::format("{:<13}  {:<23}  {}: {}\n", to_string(severity), change.rule, or_map(change),
                            printable(what(change)));
  return text +
         fmt::format("{} -> {}: {}\n", printable(versions.older), printable(versions.newer), counts(changes));
}

/// One line; docs/diff.md has its fields.
std::string diff_json(const Versions& versions, const std::vector<Change>& changes) {
  ordered_json json{{"old", versions.older}, {"new", versions.newer}, {"worst", nullptr}};
  if (const auto most = worst(changes)) json["worst"] = to_string(*most);
  json["changes"] = ordered_json::array();
  for (const Change& change : changes) {
    ordered_json entry{{"class", to_string(change.severity)}, {"rule", change.rule}, {"point", nullptr}};
    if (!change.point.empty()) entry["point"] = change.point;
    entry["old"] = change.older;
    entry["new"] = change.newer;
    json["changes"].push_back(std::move(entry));
  }
  return json_text(json) + "\n";
}

/// A table for each severity that there is, for reviews.
std::string diff_markdown(const Versions& versions, const std::vector<Change>& changes) {
  auto text =
      fmt::format("**{} → {}**: {}\n", markdown(versions.older), markdown(versions.newer), counts(changes));
  for (const Severity severity : severities) {
    if (count(changes, severity) == 0) continue;
    text += fmt::format("\n### {}\n| point | rule | old | new |\n|---|---|---|---|\n", to_string(severity));
    for (const Change& change : changes)
      if (change.severity == severity)
        text += fmt::format("| {} | {} | {} | {} |\n", markdown(or_map(change)), change.rule,
                            markdown(change.older), markdown(change.newer));
  }
  return text;
}

struct Arguments {
  Versions versions;
  TlsTexts tls;
  std::string format = "text";
  std::string fail_on = "meaning";
};

/// `name`: a word of --fail-on.
Severity severity_of(const std::string& name) {
  for (const Severity severity : severities)
    if (to_string(severity) == name) return severity;
  return Severity::documentation;
}

/// Returns the map of one side to compare. A map from a node is loaded without `security` and `tls`. A file
/// that it is compared with is loaded in the same way, or a map would differ from itself.
MapPtr comparable(const MapArgument& side, const MapArgument& other) {
  if (side.node || !other.node) return side.loaded.map;
  const MapPtr served = load_served_map(side.loaded.map->map().text, "").map;
  return served != nullptr ? served : side.loaded.map;
}

Exit run(const Arguments& arguments) {
  const MapArgument older = get_version(arguments.versions.older, arguments.tls);
  print(older.loaded.diagnostics);
  const MapArgument newer = get_version(arguments.versions.newer, arguments.tls);
  print(newer.loaded.diagnostics);
  if (!older.loaded.map) return older.exit;
  if (!newer.loaded.map) return newer.exit;
  const MapPtr before = comparable(older, newer);
  const MapPtr now = comparable(newer, older);
  const auto changes = compare(before->map(), now->map());
  const auto report = arguments.format == "json"       ? diff_json
                      : arguments.format == "markdown" ? diff_markdown
                                                       : diff_text;
  put(report(arguments.versions, changes));
  const auto most = worst(changes);
  return most && *most <= severity_of(arguments.fail_on) ? bad_input : ok;
}

}  // namespace

void add_diff(Program& program, Exit& exit) {
  auto command = program.add_command("diff", "Say what a new version of a map means for its users.");
  const auto arguments = std::make_shared<Arguments>();
  command
      .add_option("OLD", arguments->versions.older,
                  "A file, REVISION:PATH of git, or HOST[:PORT][/UNIT] of a node that serves its map")
      .required()
      .type_name("");
  command.add_option("NEW", arguments->versions.newer, "The same").required().type_name("");
  command.add_option("--format", arguments->format, "text (default), json or markdown")
      .one_of({"text", "json", "markdown"})
      .type_name("FORMAT");
  command
      .add_option(
          "--fail-on", arguments->fail_on,
          "Exit with 1 for this class or a worse one: breaking, meaning (default), compatible, documentation")
      .one_of({"breaking", "meaning", "compatible", "documentation"})
      .type_name("CLASS");
  add_tls_options(command, arguments->tls);
  command.footer(
      "Example:\n  coupler diff main:config/cell.yaml config/cell.yaml\n  coupler diff cell.yaml "
      "raspberrypi\n"
      "A change is breaking exactly when a driver with the old map would refuse a node with the new one.");
  command.callback([arguments, &exit] { exit = run(*arguments); });
}

}  // namespace coupler::tools
