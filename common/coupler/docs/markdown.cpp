// SPDX-License-Identifier: Apache-2.0
#include "coupler/docs/markdown.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "coupler/docs/escape.hpp"
#include "coupler/docs/words.hpp"

namespace coupler::docs {
namespace {

struct Column {
  std::string_view title;
  bool right;  ///< numbers
  std::string (*cell)(const Document&, const Row&);
};

/// `a` and behind it, if there is any, `b`.
std::string both(const std::string& a, std::string_view between, const std::string& b) {
  if (a.empty() || b.empty()) return a + b;
  return a + std::string(between) + b;
}

/// The name, which is a ROS name and so safe in backticks, and where it stands in the map.
std::string name_cell(const Document& document, const Row& row) {
  const std::string link = source_link(document, row);
  return link.empty() ? fmt::format("`{}`", row.name) : fmt::format("[`{}`](<{}>)", row.name, link);
}

std::string access_cell(const Document&, const Row& row) {
  return row.read_at.empty() ? row.access : fmt::format("{}; reads back at {}", row.access, row.read_at);
}

constexpr std::array columns{
    Column{"point", false, name_cell},
    Column{"wire", true, [](const Document&, const Row& row) { return both(row.wire, ", ", row.part); }},
    Column{"Modicon", true, [](const Document&, const Row& row) { return row.modicon; }},
    Column{"type", false, [](const Document&, const Row& row) { return both(row.type, ", ", row.text); }},
    Column{"count", true, [](const Document&, const Row& row) { return row.count; }},
    Column{"order", false, [](const Document&, const Row& row) { return row.order; }},
    Column{"range", false, [](const Document&, const Row& row) { return row.range; }},
    Column{"units", false, [](const Document&, const Row& row) { return markdown(row.units); }},
    Column{"scale", false, [](const Document&, const Row& row) { return row.scale; }},
    Column{"access", false, access_cell},
    Column{"behind it", false,
           [](const Document&, const Row& row) {
             return both(markdown(row.source), ": ", markdown(row.source_details));
           }},
    Column{"initial", false, [](const Document&, const Row& row) { return markdown(row.initial); }},
    Column{"safe", false, [](const Document&, const Row& row) { return markdown(row.safe); }},
    Column{"deadman", false, [](const Document&, const Row& row) { return markdown(row.deadman); }},
    Column{"polled", true, [](const Document&, const Row& row) { return row.rate; }},
    Column{"message", false, [](const Document&, const Row& row) { return "`" + row.message + "`"; }},
    Column{"description", false, [](const Document&, const Row& row) { return markdown(row.description); }},
};

/// One address space. Columns that no point of it fills are left out.
void put_table(const Document& document, Table table, std::string& out) {
  std::vector<const Row*> rows;
  for (const Row& row : document.rows)
    if (row.table == table) rows.push_back(&row);
  std::string title = words(table);
  title.front() = static_cast<char>(title.front() - 'a' + 'A');
  out += fmt::format("\n## {} ({})\n", title, rows.size());
  if (rows.empty()) return;
  std::vector<const Column*> used;
  for (const Column& column : columns)
    if (std::any_of(rows.begin(), rows.end(),
                    [&](const Row* row) { return !column.cell(document, *row).empty(); }))
      used.push_back(&column);
  out += '\n';
  for (const Column* column : used) out += fmt::format("| {} ", column->title);
  out += "|\n";
  for (const Column* column : used) out += column->right ? "|--:" : "|---";
  out += "|\n";
  for (const Row* row : rows) {
    for (const Column* column : used) out += fmt::format("| {} ", column->cell(document, *row));
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
  const std::string file = markdown(document.origin.file);
  return fmt::format(
      "# {}: register map\n\nMade from {} by coupler {}. Fingerprint `{}`.\n", markdown(document.name),
      document.origin.url.empty() ? file : fmt::format("[{}](<{}>)", file, document.origin.url),
      markdown(document.origin.version), document.fingerprint);
}

}  // namespace

std::string markdown_page(const Document& document) {
  std::string out = head(document);
  out +=
      "\nAddresses: *wire* counts from 0, as requests carry it; *Modicon* counts from 1 behind the table's "
      "digit.\n";
  for (const Table table : tables) put_table(document, table, out);
  out += "\n## The device\n\n| | |\n|---|---|\n";
  for (const FactGroup& group : document.facts)
    for (const Fact& fact : group.facts)
      out += fmt::format("| {} | {} |\n", fact.label, markdown(fact.value));
  out += "\n## How to read it\n";
  put_commands("With mbpoll:", document.mbpoll, out);
  put_commands("From ROS:", document.ros, out);
  out += fmt::format("\nThe topic of a point is `/{0}/<point>`, that of writes `/{0}/<point>/write`.\n",
                     document.name);
  return out;
}

}  // namespace coupler::docs
