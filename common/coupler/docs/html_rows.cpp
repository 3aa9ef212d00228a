// SPDX-License-Identifier: Apache-2.0
#include "coupler/docs/html_rows.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "coupler/docs/escape.hpp"
#include "coupler/docs/words.hpp"

namespace coupler::docs {
namespace {

/// What a cell says first, and what stands smaller below it; both are HTML.
struct Cell {
  std::string main;
  std::string below{};
};

struct Column {
  std::string_view key;  ///< CSS class
  std::string_view title;
  Cell (*cell)(const Document&, const Row&);
};

/// The texts that are there, with a dot between.
std::string joined(std::initializer_list<std::string> texts) {
  std::string out;
  for (const std::string& text : texts)
    if (!text.empty()) out += (out.empty() ? "" : " · ") + text;
  return out;
}

std::string prefixed(std::string_view before, const std::string& text) {
  return text.empty() ? text : std::string(before) + text;
}

Cell name(const Document&, const Row& row) {
  return {fmt::format("<a href=\"#point-{0}\">{0}</a>", html(row.name)), html(row.description)};
}

Cell space(const Document&, const Row& row) { return {words(row.table)}; }

Cell wire(const Document&, const Row& row) {
  return {row.wire, joined({row.part, prefixed("reads back at ", row.read_at)})};
}

Cell modicon(const Document&, const Row& row) { return {row.modicon}; }

Cell type(const Document&, const Row& row) {
  return {html(row.type) + prefixed(" × ", row.count), joined({row.text, prefixed("order ", row.order)})};
}

Cell range(const Document&, const Row& row) { return {row.range, row.scale}; }

Cell units(const Document&, const Row& row) { return {html(row.units)}; }

Cell access(const Document&, const Row& row) { return {row.access, prefixed("at ", row.rate)}; }

Cell behind(const Document&, const Row& row) { return {html(row.source), html(row.source_details)}; }

Cell initial(const Document&, const Row& row) {
  return {html(row.initial),
          joined({prefixed("safe: ", html(row.safe)), prefixed("deadman: ", html(row.deadman))})};
}

Cell message(const Document&, const Row& row) {
  const std::size_t slash = row.message.find('/') + 1;
  return {html(row.message.substr(slash)), html(row.message.substr(0, slash - 1))};
}

Cell source(const Document& document, const Row& row) {
  const std::string link = source_link(document, row);
  if (link.empty()) return {row.line != 0 ? fmt::format("L{}", row.line) : ""};
  return {fmt::format("<a href=\"{}\">L{}</a>", html(link), row.line)};
}

constexpr std::array columns{
    Column{"name", "Point", name},         Column{"space", "Table", space},
    Column{"wire", "Wire", wire},          Column{"modicon", "Modicon", modicon},
    Column{"type", "Type", type},          Column{"range", "Range", range},
    Column{"units", "Units", units},       Column{"access", "Access", access},
    Column{"behind", "Behind it", behind}, Column{"initial", "Initial", initial},
    Column{"message", "Message", message}, Column{"source", "Map", source},
};

/// Columns that no point fills are left out.
std::vector<const Column*> used_columns(const Document& document) {
  std::vector<const Column*> used;
  for (const Column& column : columns) {
    const bool filled = std::any_of(document.rows.begin(), document.rows.end(), [&](const Row& row) {
      const Cell cell = column.cell(document, row);
      return !cell.main.empty() || !cell.below.empty();
    });
    if (filled) used.push_back(&column);
  }
  return used;
}

/// Empty cells are there, so that columns stay columns. The numbers are for the page's search and sort.
void put_row(const Document& document, const Row& row, const std::vector<const Column*>& used,
             std::string& out) {
  out += fmt::format("<tr id=\"point-{}\" data-table=\"{}\" data-first=\"{}\" data-last=\"{}\">",
                     html(row.name), index(row.table), row.first, row.last);
  for (const Column* column : used) {
    const Cell cell = column->cell(document, row);
    out += fmt::format("<td class=\"{}\">{}", column->key, cell.main);
    if (!cell.below.empty()) out += fmt::format("<small>{}</small>", cell.below);
    out += "</td>";
  }
  out += "</tr>\n";
}

}  // namespace

std::string html_rows(const Document& document) {
  const auto used = used_columns(document);
  std::string out = "<table id=\"points\">\n<thead><tr>";
  for (const Column* column : used)
    out += fmt::format("<th scope=\"col\" class=\"{}\" data-key=\"{}\">{}</th>", column->key, column->key,
                       column->title);
  out += "</tr></thead>\n<tbody>\n";
  for (const Row& row : document.rows) put_row(document, row, used, out);
  return out + "</tbody>\n</table>\n";
}

}  // namespace coupler::docs
