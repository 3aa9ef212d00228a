// SPDX-License-Identifier: Apache-2.0
#include "coupler/docs/document.hpp"

#include <algorithm>
#include <array>
#include <initializer_list>

#include <fmt/format.h>

#include "coupler/docs/assets.hpp"
#include "coupler/docs/words.hpp"
#include "coupler/map/escape.hpp"

namespace coupler::docs {
namespace {

/// The policy forbids the browser every request, whatever the page holds.
std::string head(const Document& document) {
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data:; "
      "style-src 'unsafe-inline'; script-src 'unsafe-inline'; base-uri 'none'; form-action 'none'\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta name=\"color-scheme\" content=\"light dark\">\n"
      "<meta name=\"generator\" content=\"coupler {}\">\n"
      "<link rel=\"icon\" href=\"data:,\">\n"
      "<title>{}: register map</title>\n<style>\n{}</style>\n"
      "<script>\n{}</script>\n</head>\n",
      html(document.provenance.version), html(document.name), style_sheet(), head_script());
}

std::string made_from(const Document& document) {
  const std::string file = html(document.provenance.file);
  return fmt::format("Made from {} by coupler {} · fingerprint <code>{}</code>",
                     document.provenance.url.empty()
                         ? file
                         : fmt::format("<a href=\"{}\">{}</a>", html(document.provenance.url), file),
                     html(document.provenance.version), document.fingerprint);
}

/// Hidden until the script runs, which does the search.
std::string search(const Document& document) {
  std::string out =
      "<form id=\"search\" role=\"search\" hidden>\n"
      "<input type=\"search\" id=\"query\" placeholder=\"Search names, addresses, units …\" "
      "aria-label=\"Search points\" autocomplete=\"off\" spellcheck=\"false\">\n"
      "<fieldset><legend>Table</legend>\n"
      "<label><input type=\"radio\" name=\"table\" value=\"\" checked>all</label>\n";
  for (const Table table : tables)
    out += fmt::format("<label><input type=\"radio\" name=\"table\" value=\"{}\">{} <b>{}</b></label>\n",
                       index(table), words(table), count(document, table));
  return out + "</fieldset>\n<output id=\"found\" for=\"query\"></output>\n</form>\n";
}

/// The text of a cell, and a smaller one below it; both are HTML.
struct Cell {
  std::string main;
  std::string below{};
};

struct Column {
  std::string_view key;  ///< CSS class
  std::string_view title;
  Cell (*cell)(const Document&, const PointDescription&);
};

/// The texts that are not empty, with a dot between.
std::string joined(std::initializer_list<std::string> texts) {
  std::string out;
  for (const std::string& text : texts)
    if (!text.empty()) out += (out.empty() ? "" : " · ") + text;
  return out;
}

std::string prefixed(std::string_view before, const std::string& text) {
  return text.empty() ? text : std::string(before) + text;
}

Cell name(const Document&, const PointDescription& point) {
  return {fmt::format("<a href=\"#point-{0}\">{0}</a>", html(point.name)), html(point.description)};
}

Cell space(const Document&, const PointDescription& point) { return {words(point.table)}; }

Cell address(const Document&, const PointDescription& point) {
  return {point.address, joined({point.part, prefixed("reads back at ", point.read_at)})};
}

Cell modicon(const Document&, const PointDescription& point) { return {point.modicon}; }

Cell type(const Document&, const PointDescription& point) {
  return {html(point.type) + prefixed(" × ", point.count),
          joined({point.text, prefixed("order ", point.order)})};
}

Cell range(const Document&, const PointDescription& point) {
  return {point.range, joined({html(point.scale), prefixed("no value: ", point.invalid),
                               prefixed("fault: raw ", point.faults)})};
}

Cell units(const Document&, const PointDescription& point) { return {html(point.units)}; }

Cell access(const Document&, const PointDescription& point) {
  return {point.access, joined({prefixed("at ", point.rate), prefixed("priority ", point.priority)})};
}

Cell behind(const Document&, const PointDescription& point) {
  return {html(point.source), html(point.source_details)};
}

Cell initial(const Document&, const PointDescription& point) {
  return {html(point.initial), joined({prefixed("safe: ", html(point.safe)), prefixed("pulse: ", point.pulse),
                                       prefixed("deadman: ", html(point.deadman))})};
}

Cell message(const Document&, const PointDescription& point) {
  const std::size_t slash = point.message.find('/') + 1;
  return {html(point.message.substr(slash)), html(point.message.substr(0, slash - 1))};
}

Cell source(const Document& document, const PointDescription& point) {
  const std::string link = source_link(document, point);
  if (link.empty()) return {point.line != 0 ? fmt::format("L{}", point.line) : ""};
  return {fmt::format("<a href=\"{}\">L{}</a>", html(link), point.line)};
}

constexpr std::array columns{
    Column{"name", "Point", name},         Column{"space", "Table", space},
    Column{"address", "Address", address}, Column{"modicon", "Modicon", modicon},
    Column{"type", "Type", type},          Column{"range", "Range", range},
    Column{"units", "Units", units},       Column{"access", "Access", access},
    Column{"behind", "Behind it", behind}, Column{"initial", "Initial", initial},
    Column{"message", "Message", message}, Column{"source", "Map", source},
};

/// Columns that no point fills are left out.
std::vector<const Column*> used_columns(const Document& document) {
  std::vector<const Column*> used;
  for (const Column& column : columns) {
    const bool filled =
        std::any_of(document.points.begin(), document.points.end(), [&](const PointDescription& point) {
          const Cell cell = column.cell(document, point);
          return !cell.main.empty() || !cell.below.empty();
        });
    if (filled) used.push_back(&column);
  }
  return used;
}

/// Empty cells are written, too. The data attributes are for search and sort.
void put_point(const Document& document, const PointDescription& point,
               const std::vector<const Column*>& used, std::string& out) {
  out += fmt::format("<tr id=\"point-{}\" data-table=\"{}\" data-first=\"{}\" data-last=\"{}\">",
                     html(point.name), index(point.table), point.first, point.last);
  for (const Column* column : used) {
    const Cell cell = column->cell(document, point);
    out += fmt::format("<td class=\"{}\">{}", column->key, cell.main);
    if (!cell.below.empty()) out += fmt::format("<small>{}</small>", cell.below);
    out += "</td>";
  }
  out += "</tr>\n";
}

/// Sorted as the map's points are.
std::string html_rows(const Document& document) {
  const auto used = used_columns(document);
  std::string out = "<table id=\"points\">\n<thead><tr>";
  for (const Column* column : used)
    out += fmt::format("<th scope=\"col\" class=\"{}\" data-key=\"{}\">{}</th>", column->key, column->key,
                       column->title);
  out += "</tr></thead>\n<tbody>\n";
  for (const PointDescription& point : document.points) put_point(document, point, used, out);
  return out + "</tbody>\n</table>\n";
}

/// How values stand in registers.
std::string drawings(const Document& document) {
  if (document.drawings.empty()) return {};
  std::string out =
      "<section id=\"order\">\n<h2>Bytes and bits</h2>\n<p class=\"note\">Registers as a reply has them, the "
      "high "
      "byte of each first.</p>\n<div class=\"drawings\">\n";
  for (const Drawing& drawing : document.drawings)
    out += fmt::format(
        "<div><h3>{}</h3>\n<p>{}</p>\n<div class=\"drawing\" tabindex=\"0\" role=\"region\" "
        "aria-label=\"Drawing of {}\">\n{}</div></div>\n",
        html(drawing.title), html(drawing.explanation), html(drawing.title), as_svg(drawing));
  return out + "</div>\n</section>\n";
}

/// The tools, or the axes.
template <class Description>
std::string descriptions(std::string_view id, std::string_view title, const std::vector<Description>& all) {
  if (all.empty()) return {};
  std::string out = fmt::format("<section id=\"{}\">\n<h2>{}</h2>\n<div class=\"groups\">\n", id, title);
  for (const Description& each : all) {
    out += fmt::format("<div><h3>{}</h3>\n<dl>\n", html(each.name));
    for (const auto& column : used_columns(all)) {
      const std::string& text = each.*column.text;
      if (column.text == &Description::name || text.empty()) continue;
      out += fmt::format("<dt>{}{}</dt><dd>{}</dd>\n", static_cast<char>(column.title[0] - 'a' + 'A'),
                         column.title.substr(1), html(text));
    }
    out += "</dl></div>\n";
  }
  return out + "</div>\n</section>\n";
}

std::string facts(const Document& document) {
  std::string out = "<section id=\"device\">\n<h2>The device</h2>\n<div class=\"groups\">\n";
  for (const FactGroup& group : document.facts) {
    out += fmt::format("<div><h3>{}</h3>\n<dl>\n", html(group.title));
    for (const Fact& fact : group.facts)
      out += fmt::format("<dt>{}</dt><dd>{}</dd>\n", html(fact.label), html(fact.value));
    out += "</dl></div>\n";
  }
  return out + "</div>\n</section>\n";
}

std::string commands(std::string_view title, const std::vector<Command>& commands) {
  if (commands.empty()) return {};
  std::string out = fmt::format("<h3>{}</h3>\n<dl class=\"commands\">\n", title);
  for (const Command& command : commands)
    out += fmt::format("<dt>{}</dt><dd><code>{}</code></dd>\n", html(command.what), html(command.line));
  return out + "</dl>\n";
}

std::string use(const Document& document) {
  return "<section id=\"use\">\n<h2>How to read it</h2>\n" + commands("With mbpoll", document.mbpoll) +
         commands("From ROS", document.ros) +
         fmt::format(
             "<p>The topic of a point is <code>/{0}/&lt;point&gt;</code>, that of writes "
             "<code>/{0}/&lt;point&gt;/write</code>; the messages are in the table.{1}</p>\n</section>\n",
             html(document.name),
             document.tools.empty()
                 ? ""
                 : fmt::format(" A tool has the services <code>/{0}/&lt;tool&gt;/close</code> and "
                               "<code>/{0}/&lt;tool&gt;/open</code>, and the topic "
                               "<code>/{0}/&lt;tool&gt;/state</code>.",
                               html(document.name)));
}

}  // namespace

std::string html_page(const Document& document) {
  return head(document) +
         fmt::format(
             "<body>\n<a class=\"skip\" href=\"#points\">Skip to the "
             "points</a>\n<header>\n<h1>{}</h1>\n<p>{}</p>\n"
             "<nav><a href=\"#list\">Points</a> <a href=\"#spaces\">Address spaces</a> {}{}{}"
             "<a href=\"#device\">The device</a> <a href=\"#use\">How to read "
             "it</a></nav>\n</header>\n<main>\n",
             html(document.name), made_from(document),
             document.tools.empty() ? "" : "<a href=\"#tools\">Tools</a> ",
             document.axes.empty() ? "" : "<a href=\"#axes\">Axes</a> ",
             document.drawings.empty() ? "" : "<a href=\"#order\">Bytes and bits</a> ") +
         "<section id=\"list\">\n<h2>Points</h2>\n" + search(document) + html_rows(document) +
         "<p class=\"note\">Address counts from 0, as requests carry it. Modicon counts from 1 behind the "
         "digit "
         "of the "
         "table.</p>\n</section>\n"
         "<section id=\"spaces\">\n<h2>Address spaces</h2>\n<div class=\"picture\" tabindex=\"0\" "
         "role=\"region\" "
         "aria-label=\"Picture of the address spaces\">\n" +
         document.picture + "</div>\n</section>\n" + descriptions("tools", "Tools", document.tools) +
         descriptions("axes", "Axes", document.axes) + drawings(document) + facts(document) + use(document) +
         "</main>\n<script>\n" + std::string(page_script()) + "</script>\n</body>\n</html>\n";
}

}  // namespace coupler::docs
