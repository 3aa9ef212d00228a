// SPDX-License-Identifier: Apache-2.0
#include "coupler/cli/diff_report.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "coupler/map/printable.hpp"

namespace coupler::cli {
namespace {

using changes::Change;
using changes::Severity;
using nlohmann::ordered_json;

constexpr std::array severities{Severity::breaking, Severity::compatible, Severity::documentation};

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
  if (change.rule == "point-removed") return change.older;
  return change.rule == "point-added" ? change.newer : from_to(change);
}

/// A cell of a table: no bar and no newline ends it, and no mark of it is taken for Markdown's.
std::string cell(std::string_view text) {
  std::string out;
  for (const char c : printable_lines(text)) {
    if (c == '\n') {
      out += ' ';
      continue;
    }
    if (std::string_view("|`*_[]<>\\#&").find(c) != std::string_view::npos) out += '\\';
    out += c;
  }
  return out;
}

std::string_view or_map(const Change& change) {
  return change.point.empty() ? std::string_view("(map)") : change.point;
}

}  // namespace

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

std::string diff_json(const Versions& versions, const std::vector<Change>& changes) {
  ordered_json json{{"old", versions.older}, {"new", versions.newer}, {"worst", nullptr}};
  if (const auto worst = changes::worst(changes)) json["worst"] = to_string(*worst);
  json["changes"] = ordered_json::array();
  for (const Change& change : changes) {
    ordered_json entry{{"class", to_string(change.severity)}, {"rule", change.rule}, {"point", nullptr}};
    if (!change.point.empty()) entry["point"] = change.point;
    entry["old"] = change.older;
    entry["new"] = change.newer;
    json["changes"].push_back(std::move(entry));
  }
  // A map may have bytes in its texts that are not UTF-8.
  return json.dump(-1, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

std::string diff_markdown(const Versions& versions, const std::vector<Change>& changes) {
  auto text = fmt::format("**{} → {}**: {}\n", cell(versions.older), cell(versions.newer), counts(changes));
  for (const Severity severity : severities) {
    if (count(changes, severity) == 0) continue;
    text += fmt::format("\n### {}\n| point | rule | old | new |\n|---|---|---|---|\n", to_string(severity));
    for (const Change& change : changes)
      if (change.severity == severity)
        text += fmt::format("| {} | {} | {} | {} |\n", cell(or_map(change)), change.rule, cell(change.older),
                            cell(change.newer));
  }
  return text;
}

}  // namespace coupler::cli
