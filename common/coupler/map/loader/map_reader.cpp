// SPDX-License-Identifier: Apache-2.0
#include "coupler/map/loader/map_reader.hpp"

#include <algorithm>
#include <tuple>
#include <unordered_map>

#include <fmt/format.h>

#include "coupler/map/loader/addressed_text.hpp"
#include "coupler/map/loader/map_keys.hpp"
#include "coupler/map/loader/names.hpp"
#include "coupler/map/loader/point_keys.hpp"
#include "coupler/map/loader/point_reader.hpp"
#include "coupler/map/loader/preset.hpp"
#include "coupler/map/loader/rules.hpp"

namespace coupler::loader {
namespace {

std::string_view read_name(const Reader& top, const Entry& root, Context& context) {
  std::string_view name;
  const std::size_t errors = context.problems.errors();
  top.text("name", name);
  if (const Entry* entry = top.find("name")) {
    if (context.problems.errors() == errors) check_map_name(name, entry->at, context);
  } else if (!context.name.empty()) {
    name = context.map.keep(std::string(context.name));
    check_map_name(name, root.at, context);
  } else {
    context.problems.error(root.at, "the map has no 'name'", "add 'name: NAME', the namespace of its topics");
  }
  return name;
}

PointDefaults read_point_defaults(const Reader& top) {
  PointDefaults defaults;
  bool bytes_reversed = false;
  bool most_significant_first = false;
  top.choice("addressing", defaults.addressing);
  top.boolean("byteorder_reverse", bytes_reversed);
  top.boolean("wordorder_reverse", most_significant_first);
  defaults.order = codec::make_order(!most_significant_first, bytes_reversed);
  defaults.host = read_host_defaults(top);
  return defaults;
}

/// The points of the file and the readers of their options, side by side.
struct OpenPoints {
  DraftPoints drafts;
  std::vector<Reader> options;
};

struct TableEntry {
  const Entry* entry;
  Table table;
};

void find_points(const Entry& entry, Table table, std::vector<TableEntry>& found, Context& context) {
  const std::string expected = fmt::format("'{}' holds points", to_string(table));
  if (!check_map(entry, expected, "write one 'name: ...' a point below it", context)) return;
  for (const Entry& point : entry.children) found.push_back({&point, table});
}

/// In the order of the file.
std::vector<TableEntry> find_points(const Reader& top, const Entry& root, Context& context) {
  std::vector<TableEntry> found;
  const Entry* mapping = top.find("mapping");
  if (mapping == nullptr) {
    context.problems.error(root.at, "the map has no 'mapping'",
                           "add 'mapping:' with the tables and their points");
    return found;
  }
  if (!check_map(*mapping, "'mapping' holds the tables",
                 "write 'coils:', 'holding_registers:' or another table below it", context))
    return found;
  const Reader reader(*mapping, Section::mapping, context);
  for (const Table table : tables)
    if (const Entry* entry = reader.find(to_string(table))) find_points(*entry, table, found, context);
  std::stable_sort(found.begin(), found.end(), [](const TableEntry& a, const TableEntry& b) {
    return std::tie(a.entry->key_at.line, a.entry->key_at.column) <
           std::tie(b.entry->key_at.line, b.entry->key_at.column);
  });
  return found;
}

/// Points without an address are not placed yet.
OpenPoints read_places(const std::vector<TableEntry>& entries, const PointDefaults& defaults,
                       Context& context) {
  OpenPoints points;
  points.drafts.reserve(entries.size());
  points.options.reserve(entries.size());
  for (const auto& [entry, table] : entries) {
    points.options.emplace_back(*entry, section_of(table), context);
    points.drafts.push_back(read_place(*entry, table, points.options.back(), defaults, context));
  }
  return points;
}

void check_points(const DraftPoints& points, const Limits& limits, bool addressing_given, Context& context) {
  check_point_names(points, context);
  check_overlaps(points, context);
  check_lines(points, context);
  check_sizes(points, limits, context);
  if (!addressing_given) warn_of_modicon_numbers(points, context);
}

/// For the points in the map's order; their names are unique.
std::vector<int> lines_of(Span<const Point> points, const DraftPoints& drafts) {
  std::unordered_map<std::string_view, int> line_of;
  for (const DraftPoint& draft : drafts) line_of.emplace(draft.point.name, draft.name_at.line);
  std::vector<int> lines;
  lines.reserve(points.size());
  for (const Point& point : points) lines.push_back(line_of.at(point.name));
  return lines;
}

}  // namespace

void read_map(const Entry& file, std::string_view text, Placement& placement, Context& context) {
  if (file.kind != Entry::Kind::map) {
    context.problems.error(file.at, fmt::format("a map of a coupler has keys, this is {}", shown(file)),
                           "begin with 'name: NAME'");
    return;
  }
  context.origin = may_be_of_the_origin(file);
  const auto preset = read_preset(file, context);
  const Entry root = preset ? completed(file, *preset) : file;
  const Reader top(root, Section::map, context);
  Map head;
  head.name = read_name(top, root, context);
  head.connection = read_connection(top, context);
  head.polling = read_polling(top);
  head.limits = read_limits(top);
  head.service = read_service(top, context);
  top.fields(head);
  const PointDefaults defaults = read_point_defaults(top);
  const Areas unreadable = read_areas(top, "unreadable", defaults.addressing, context);
  const Areas reserved = read_areas(top, "reserve", defaults.addressing, context);
  OpenPoints points = read_places(find_points(top, root, context), defaults, context);
  DraftPoints& drafts = points.drafts;
  place_points(drafts, free_space_of(drafts, reserved, unreadable, preset), placement, context);
  for (std::size_t i = 0; i < drafts.size(); ++i) read_rest(points.options[i], defaults, drafts[i], context);
  if (preset) apply(*preset, drafts, context);
  check_points(drafts, head.limits, top.has("addressing"), context);
  read_coupler_watchdog(top, preset, drafts, defaults.addressing, head, context);
  std::vector<SimWire> sim = read_sim(top, drafts, context);
  check_edges(drafts, sim, context);
  check_unreadable(unreadable, drafts, context);
  check_reserved(reserved, drafts, context);
  head.unreadable = context.map.keep(sorted_unreadable(unreadable));
  if (context.problems.has_errors()) return;

  const auto left_out =
      std::find_if(drafts.begin(), drafts.end(), [](const DraftPoint& d) { return d.addressless; });
  const bool complete = left_out == drafts.end();
  if (!complete) context.filled_in = left_out->name_at;
  head.text =
      context.map.keep(complete ? std::string(text) : addressed_text(text, drafts, defaults.addressing));
  std::vector<Point> finished;
  finished.reserve(drafts.size());
  for (const DraftPoint& draft : drafts) finished.push_back(draft.point);
  context.map.finish(head, finished, sim);
  context.point_lines = lines_of(context.map.map().points, drafts);
}

}  // namespace coupler::loader
