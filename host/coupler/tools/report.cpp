// SPDX-License-Identifier: Apache-2.0
#include "coupler/tools/report.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "coupler/json/json_text.hpp"
#include "coupler/map/fingerprint.hpp"
#include "coupler/map/joint.hpp"
#include "coupler/map/printable.hpp"
#include "coupler/map/rights_text.hpp"

namespace coupler::tools {
namespace {

using nlohmann::ordered_json;

std::string_view singular(Table table) {
  switch (table) {
    case Table::coils: return "coil";
    case Table::discrete_inputs: return "discrete input";
    case Table::input_registers: return "input register";
    case Table::holding_registers: return "holding register";
  }
  return {};
}

std::string counted(std::ptrdiff_t count, std::string_view noun) {
  return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

std::string by_table(const Map& map) {
  std::string out;
  for (const Table table : tables) {
    const auto count = std::count_if(map.points.begin(), map.points.end(),
                                     [table](const Point& point) { return point.table == table; });
    if (count != 0) out += fmt::format("{}{}", out.empty() ? "" : ", ", counted(count, singular(table)));
  }
  return out.empty() ? out : " (" + out + ")";
}

std::string listed(const std::vector<std::string>& names) {
  constexpr std::size_t most = 10;
  std::string text;
  for (std::size_t i = 0; i < std::min(names.size(), most); ++i)
    text += fmt::format("{}'{}'", i == 0 ? "" : ", ", names[i]);
  return names.size() > most ? fmt::format("{} and {} more", text, names.size() - most) : text;
}

ordered_json to_json(const Diagnostic& diagnostic) {
  ordered_json notes = ordered_json::array();
  for (const Diagnostic::Note& note : diagnostic.notes)
    notes.push_back({{"line", note.line}, {"column", note.column}, {"what", note.what}});
  return {{"severity", diagnostic.severity == Diagnostic::Severity::error ? "error" : "warning"},
          {"file", diagnostic.file},
          {"line", diagnostic.line},
          {"column", diagnostic.column},
          {"what", diagnostic.what},
          {"remedy", diagnostic.remedy},
          {"notes", std::move(notes)}};
}

}  // namespace

std::string summary(const std::string& file, const Map& map) {
  const auto tools = static_cast<std::ptrdiff_t>(map.tools.size());
  const std::size_t axes = map.axes.size();
  return fmt::format("{}: ok: {}, {}{}{}{}, fingerprint {}", printable(file), map.name,
                     counted(static_cast<std::ptrdiff_t>(map.points.size()), "point"), by_table(map),
                     tools == 0 ? "" : ", " + counted(tools, "tool"),
                     axes == 0 ? "" : fmt::format(", {} {}", axes, axes == 1 ? "axis" : "axes"),
                     fingerprint_text(map.fingerprint));
}

std::string moveit_margin(const Map& map) {
  std::chrono::milliseconds longest{0};
  for (const Tool& tool : map.tools)
    if (is_described_as_joint(tool)) longest = std::max(longest, tool.timeout);
  if (longest.count() == 0) return {};
  // Before it moves and at its end a goal may wait so long, too, for each write.
  return fmt::format(
      "  for MoveIt: allowed_goal_duration_margin: {} or more (four times the longest timeout)\n",
      std::chrono::duration<double>(4 * longest).count());
}

namespace {

std::string role_text(const Security& security, std::optional<std::uint16_t> role) {
  return role ? "as " + printable(security.roles[*role].name) : "no rights";
}

}  // namespace

std::string rights_table(const Map& map) {
  if (!map.security.present()) return {};
  std::vector<std::array<std::string, 3>> rows{{"role", "may read", "may write"}};
  for (const Role& role : map.security.roles)
    rows.push_back(
        {printable(role.name), rights_text(map, role, Right::read), rights_text(map, role, Right::write)});
  std::array<std::size_t, 2> widths{};
  for (const auto& row : rows)
    for (std::size_t i = 0; i < widths.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  std::string text;
  for (const auto& [role, read, write] : rows)
    text += fmt::format("  {:<{}}  {:<{}}  {}\n", role, widths[0], read, widths[1], write);
  const auto plain = map.security.plain;
  text += fmt::format("  {}: {}\n", plain_clients(map.security), role_text(map.security, plain));
  if (map.security.files.present())
    text += fmt::format("  certificates without one of these roles: {}\n",
                        role_text(map.security, map.security.no_role));
  return text;
}

std::string lock_report(const NewLock& lock) {
  if (lock.text.empty()) return {};
  std::string text = fmt::format("{}: written", lock.path);
  if (!lock.allocated.empty()) text += fmt::format("; new addresses: {}", listed(lock.allocated));
  if (!lock.retired.empty()) text += fmt::format("; retired: {}", listed(lock.retired));
  text += '\n';
  if (!lock.allocated.empty() && !lock.retired.empty())
    text += fmt::format(
        "{}: a point that was only renamed can keep its address: take the lock from version control again, "
        "and write the new name over the old one\n",
        lock.path);
  return text;
}

std::string json_report(const std::string& file, const LoadResult& loaded) {
  ordered_json report{{"file", file},
                      {"ok", loaded.map != nullptr},
                      {"name", nullptr},
                      {"points", nullptr},
                      {"fingerprint", nullptr},
                      {"lock", nullptr},
                      {"diagnostics", ordered_json::array()}};
  if (loaded.map) {
    const Map& map = loaded.map->map();
    report["name"] = map.name;
    report["points"] = map.points.size();
    report["fingerprint"] = fingerprint_text(map.fingerprint);
  }
  const NewLock& lock = loaded.lock;
  if (!lock.text.empty())
    report["lock"] = {{"file", lock.path}, {"allocated", lock.allocated}, {"retired", lock.retired}};
  for (const Diagnostic& diagnostic : loaded.diagnostics)
    report["diagnostics"].push_back(to_json(diagnostic));
  return json_text(report);
}

}  // namespace coupler::tools
