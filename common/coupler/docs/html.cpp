// SPDX-License-Identifier: Apache-2.0
#include "coupler/docs/html.hpp"

#include <fmt/format.h>

#include "coupler/docs/assets.hpp"
#include "coupler/docs/escape.hpp"
#include "coupler/docs/html_rows.hpp"
#include "coupler/docs/words.hpp"

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
      html(document.origin.version), html(document.name), style_sheet(), head_script());
}

std::string made_from(const Document& document) {
  const std::string file = html(document.origin.file);
  return fmt::format("Made from {} by coupler {} · fingerprint <code>{}</code>",
                     document.origin.url.empty()
                         ? file
                         : fmt::format("<a href=\"{}\">{}</a>", html(document.origin.url), file),
                     html(document.origin.version), document.fingerprint);
}

/// Hidden until the script is there to answer it.
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
             "<code>/{0}/&lt;point&gt;/write</code>; the messages are in the table.</p>\n</section>\n",
             html(document.name));
}

}  // namespace

std::string html_page(const Document& document) {
  return head(document) +
         fmt::format(
             "<body>\n<a class=\"skip\" href=\"#points\">Skip to the "
             "points</a>\n<header>\n<h1>{}</h1>\n<p>{}</p>\n"
             "<nav><a href=\"#list\">Points</a> <a href=\"#spaces\">Address spaces</a> "
             "<a href=\"#device\">The device</a> <a href=\"#use\">How to read "
             "it</a></nav>\n</header>\n<main>\n",
             html(document.name), made_from(document)) +
         "<section id=\"list\">\n<h2>Points</h2>\n" + search(document) + html_rows(document) +
         "<p class=\"note\">Wire counts from 0, as requests carry it. Modicon counts from 1 behind the digit "
         "of the "
         "table.</p>\n</section>\n"
         "<section id=\"spaces\">\n<h2>Address spaces</h2>\n<div class=\"picture\" tabindex=\"0\" "
         "role=\"region\" "
         "aria-label=\"Picture of the address spaces\">\n" +
         document.picture + "</div>\n</section>\n" + facts(document) + use(document) + "</main>\n<script>\n" +
         std::string(page_script()) + "</script>\n</body>\n</html>\n";
}

}  // namespace coupler::docs
