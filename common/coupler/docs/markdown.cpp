// SPDX-License-Identifier: Apache-2.0
#include "coupler/docs/document.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "coupler/docs/words.hpp"
#include "coupler/map/escape.hpp"

namespace coupler::docs {
namespace {

struct Column {
  std::string_view title;
  bool right;  ///< numbers
  std::string (*cell)(const Document&, const PointDescription&);
};

/// `a` and behind it, if there is any, `b`.
std::string both(const std::string& a, std::string_view between, const std::string& b) {
  if (a.empty() || b.empty()) return a + b;
  return a + std::string(between) + b;
}

/// Keeps a line from ending between two of several addresses.
std::string unbroken(const std::string& addresses) {
  std::string out;
  for (const char c : addresses) out += c == ' ' ? std::string("&nbsp;") : std::string(1, c);
  return out;
}

/// The name, which is a ROS name and so safe in backticks, and where it stands in the map.
std::string name_cell(const Document& document, const PointDescription& point) {
  const std::string link = source_link(document, point);
  return link.empty() ? fmt::format("`{}`", point.name) : fmt::format("[`{}`](<{}>)", point.name, link);
}

std::string access_cell(const Document&, const PointDescription& point) {
  return point.read_at.empty() ? point.access
                               : fmt::format("{}; reads back at {}", point.access, point.read_at);
}

constexpr std::array columns{
    Column{"point", false, name_cell},
    Column{"address", true,
           [](auto&, auto& point) { return both(unbroken(point.address), ", ", point.part); }},
    Column{"Modicon", true, [](auto&, auto& point) { return unbroken(point.modicon); }},
    Column{"type", false, [](auto&, auto& point) { return both(point.type, ", ", point.text); }},
    Column{"count", true, [](auto&, auto& point) { return point.count; }},
    Column{"order", false, [](auto&, auto& point) { return point.order; }},
    Column{"range", false, [](auto&, auto& point) { return point.range; }},
    Column{"units", false, [](auto&, auto& point) { return markdown(point.units); }},
    Column{"scale", false, [](auto&, auto& point) { return markdown(point.scale); }},
    Column{"no value", false, [](auto&, auto& point) { return point.invalid; }},
    Column{"fault (raw)", false, [](auto&, auto& point) { return point.faults; }},
    Column{"access", false, access_cell},
    Column{"behind it", false,
           [](auto&, auto& point) {
             return both(markdown(point.source), ": ", markdown(point.source_details));
           }},
    Column{"initial", false, [](auto&, auto& point) { return markdown(point.initial); }},
    Column{"safe", false, [](auto&, auto& point) { return markdown(point.safe); }},
    Column{"pulse", false, [](auto&, auto& point) { return point.pulse; }},
    Column{"deadman", false, [](auto&, auto& point) { return markdown(point.deadman); }},
    Column{"priority", false, [](auto&, auto& point) { return point.priority; }},
    Column{"polled", true, [](auto&, auto& point) { return point.rate; }},
    Column{"message", false, [](auto&, auto& point) { return "`" + point.message + "`"; }},
    Column{"description", false, [](auto&, auto& point) { return markdown(point.description); }},
};

/// One address space. Columns that no point of it fills are left out.
void put_table(const Document& document, Table table, std::string& out) {
  std::vector<const PointDescription*> points;
  for (const PointDescription& point : document.points)
    if (point.table == table) points.push_back(&point);
  std::string title = words(table);
  title.front() = static_cast<char>(title.front() - 'a' + 'A');
  out += fmt::format("\n## {} ({})\n", title, points.size());
  if (points.empty()) return;
  std::vector<const Column*> used;
  for (const Column& column : columns)
    if (std::any_of(points.begin(), points.end(),
                    [&](const PointDescription* point) { return !column.cell(document, *point).empty(); }))
      used.push_back(&column);
  out += '\n';
  for (const Column* column : used) out += fmt::format("| {} ", column->title);
  out += "|\n";
  for (const Column* column : used) out += column->right ? "|--:" : "|---";
  out += "|\n";
  for (const PointDescription* point : points) {
    for (const Column* column : used) out += fmt::format("| {} ", column->cell(document, *point));
    out += "|\n";
  }
}

/// The tools, or the axes.
template <class Description>
void put_descriptions(std::string_view title, const std::vector<Description>& rows, std::string& out) {
  if (rows.empty()) return;
  const auto used = used_columns(rows);
  out += fmt::format("\n## {} ({})\n\n", title, rows.size());
  for (const auto& column : used) out += fmt::format("| {} ", column.title);
  out += "|\n";
  for (std::size_t i = 0; i < used.size(); ++i) out += "|---";
  out += "|\n";
  for (const Description& row : rows) {
    for (const auto& column : used) out += fmt::format("| {} ", markdown(row.*column.text));
    out += "|\n";
  }
}

void put_commands(std::string_view title, const std::vector<Command>& commands, std::string& out) {
  if (commands.empty()) return;
  out += fmt::format("\n{}\n\n```sh\n", title);
  for (const Command& command : commands)
    out += fmt::format("{}   # {}\n", one_line(command.line), command.what);
  out += "```\n";
}

std::string head(const Document& document) {
  const std::string file = markdown(document.provenance.file);
  return fmt::format(
      "# {}: register map\n\nMade from {} by coupler {}. Fingerprint `{}`.\n", markdown(document.name),
      document.provenance.url.empty() ? file : fmt::format("[{}](<{}>)", file, document.provenance.url),
      markdown(document.provenance.version), document.fingerprint);
}

}  // namespace

std::string markdown_page(const Document& document) {
  std::string out = head(document);
  out +=
      "\nAddresses: *address* counts from 0, as requests carry it; *Modicon* counts from 1 behind the "
      "table's "
      "digit.\n";
  for (const Table table : tables) put_table(document, table, out);
  put_descriptions("Tools", document.tools, out);
  put_descriptions("Axes", document.axes, out);
  out += "\n## The device\n\n| | |\n|---|---|\n";
  for (const FactGroup& group : document.facts)
    for (const Fact& fact : group.facts)
      out += fmt::format("| {} | {} |\n", fact.label, markdown(fact.value));
  if (!document.drawings.empty())
    out += "\n## Bytes and bits\n\nRegisters as a reply has them, the high byte of each first.\n";
  for (const Drawing& drawing : document.drawings)
    out += fmt::format("\n**{}.** {}\n\n```text\n{}```\n", markdown(drawing.title),
                       markdown(drawing.explanation), as_text(drawing));
  out += "\n## How to read it\n";
  put_commands("With mbpoll:", document.mbpoll, out);
  put_commands("From ROS:", document.ros, out);
  out += fmt::format("\nThe topic of a point is `/{0}/<point>`, that of writes `/{0}/<point>/write`.\n",
                     document.name);
  if (!document.tools.empty())
    out += fmt::format(
        "A tool has the services `/{0}/<tool>/close` and `/{0}/<tool>/open`, and the topic "
        "`/{0}/<tool>/state`.\n",
        document.name);
  return out;
}

}  // namespace coupler::docs
