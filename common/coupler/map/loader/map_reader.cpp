// SPDX-License-Identifier: Apache-2.0
#include "coupler/map/loader/map_reader.hpp"

#include <algorithm>
#include <tuple>
#include <unordered_map>

#include <fmt/format.h>

#include "coupler/map/loader/names.hpp"
#include "coupler/map/loader/point_reader.hpp"
#include "coupler/map/loader/preset.hpp"
#include "coupler/map/loader/rules.hpp"

namespace coupler::loader {
namespace {

std::string_view read_name(const Reader& top, const Entry& root, std::string_view otherwise,
                           const Context& context) {
  std::string_view name;
  const std::size_t errors = context.problems.errors();
  top.text("name", name);
  if (const Entry* entry = top.find("name")) {
    if (context.problems.errors() == errors) check_map_name(name, entry->at, context);
  } else if (!otherwise.empty()) {
    name = context.map.keep(std::string(otherwise));
    check_map_name(name, root.at, context);
  } else if (top.lacks("name")) {
    context.problems.error(root.at, "the map has no 'name'", "add 'name: NAME', the namespace of its topics");
  }
  return name;
}

/// Everything but the points and what depends on them.
Map read_head(const Reader& top, const Entry& root, std::string_view name, const Entry* usual_line,
              const Context& context) {
  Map head;
  head.name = read_name(top, root, name, context);
  std::uint16_t port_without_tls = 0;
  head.connection = read_connection(top, usual_line, port_without_tls, context);
  head.polling = read_polling(top);
  head.limits = read_limits(top);
  head.service = read_service(top, context);
  head.service.port = port_without_tls;
  top.fields(head);
  if (context.served) head.verify = Verify::require;  // what a node says of itself does not count
  return head;
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

struct TableEntry {
  const Entry* entry;
  Table table;
};

void find_points(const Entry& entry, Table table, std::vector<TableEntry>& found, const Context& context) {
  const std::string expected = fmt::format("'{}' holds points", to_string(table));
  if (!check_map(entry, expected, "write one 'name: ...' a point below it", context)) return;
  const Entry* before = nullptr;
  for (const Entry& point : entry.children) {
    if (before != nullptr && before->kind == Entry::Kind::null && point.kind != Entry::Kind::null &&
        !context.served && find_key(point.key, section_of(table)) != nullptr)
      context.problems.warning(point.key_at, fmt::format("this makes a point called '{}'", point.key),
                               fmt::format("indent it further if it belongs to {}", shown(before->key)));
    before = &point;
    found.push_back({&point, table});
  }
}

/// In the order of the file.
std::vector<TableEntry> find_points(const Reader& top, const Entry& root, const Context& context) {
  std::vector<TableEntry> found;
  const Entry* mapping = top.find("mapping");
  if (mapping == nullptr) {
    if (!top.lacks("mapping")) return found;
    context.problems.error(
        root.at, "the map has no 'mapping'",
        "add 'mapping:' with the tables and their points, as in 'mapping: {coils: {valve: 0}}'");
    return found;
  }
  if (!check_map(*mapping, "'mapping' holds the tables",
                 "write 'coils:', 'holding_registers:' or another table below it", context))
    return found;
  const std::size_t errors = context.problems.errors();
  const Reader reader(*mapping, Section::mapping, context);
  for (const Table table : tables)
    if (const Entry* entry = reader.find(to_string(table))) find_points(*entry, table, found, context);
  if (found.empty() && context.problems.errors() == errors && !context.served)
    context.problems.error(mapping->key_at, "the map has no points",
                           "add one to its table, as in 'mapping: {coils: {valve: 0}}'");
  std::stable_sort(found.begin(), found.end(), [](const TableEntry& a, const TableEntry& b) {
    return std::tie(a.entry->key_at.line, a.entry->key_at.column) <
           std::tie(b.entry->key_at.line, b.entry->key_at.column);
  });
  return found;
}

/// Those without an address are not placed yet.
DraftPoints read_places(const Reader& top, const Entry& root, const PointDefaults& defaults,
                        const Context& context) {
  DraftPoints points;
  for (const auto& [entry, table] : find_points(top, root, context))
    points.push_back(read_place(*entry, table, defaults, context));
  return points;
}

void check_points(const DraftPoints& points, const Map& head, bool addressing_given, const Context& context) {
  check_point_names(points, head.wait_for, context);
  check_overlaps(points, context);
  check_lines(points, context);
  check_sizes(points, head.limits, context);
  if (!addressing_given) warn_of_modicon_numbers(points, context);
}

/// Returns the lines of the points in the map's order. Their names are unique.
std::vector<int> lines_of(Span<const Point> points, const DraftPoints& drafts) {
  std::unordered_map<std::string_view, int> line_of;
  for (const DraftPoint& draft : drafts) line_of.emplace(draft.point.name, draft.name_at.line);
  std::vector<int> lines;
  lines.reserve(points.size());
  for (const Point& point : points) lines.push_back(line_of.at(point.name));
  return lines;
}

MapLayout finish(Map head, const DraftPoints& drafts, const std::vector<SimWire>& sim, std::string_view text,
                 Addressing addressing, OwnedMap& map) {
  const auto left_out =
      std::find_if(drafts.begin(), drafts.end(), [](const DraftPoint& d) { return d.addressless; });
  const bool complete = left_out == drafts.end();
  head.text = map.keep(completed_text(text, drafts, addressing));
  std::vector<Point> points;
  points.reserve(drafts.size());
  for (const DraftPoint& draft : drafts) points.push_back(draft.point);
  map.finish(head, points, sim);
  return {lines_of(map.map().points, drafts), complete ? Position{} : left_out->name_at};
}

}  // namespace

std::optional<MapLayout> read_map(const Entry& file, const MapSource& source, Placement& placement,
                                  Problems& problems, OwnedMap& map) {
  const Context context{problems, map, source.served, has_only_inherited_keys(file),
                        map.keep(std::string(source.folder))};
  if (is_entry_without_colon(file, context)) return std::nullopt;
  if (file.kind != Entry::Kind::map) {
    problems.error(file.at, fmt::format("a map consists of keys, but this is {}", shown(file)),
                   "begin with 'name: NAME'");
    return std::nullopt;
  }
  const auto preset = read_preset(file, context);
  const Entry root = preset ? completed(file, *preset) : file;
  const Reader top(root, Section::map, context);
  const Entry* usual_line = preset ? child(preset->map, "serial") : nullptr;
  Map head = read_head(top, root, source.name, usual_line, context);
  const PointDefaults defaults = read_point_defaults(top);
  const Areas unreadable = read_areas(top, "unreadable", defaults.addressing, context);
  const Areas reserved = read_areas(top, "reserve", defaults.addressing, context);

  DraftPoints points = read_places(top, root, defaults, context);
  place_points(points, free_space_of(points, reserved, unreadable, preset), placement, context);
  for (DraftPoint& draft : points) read_rest(defaults, draft, context);
  if (preset) apply(*preset, points, context);

  check_points(points, head, top.has("addressing"), context);
  read_coupler_watchdog(top, preset, points, defaults.addressing, head, context);
  const std::vector<SimWire> sim = read_sim(top, points, context);
  check_edges(points, sim, context);
  check_exponents(points, context);
  check_unreadable(unreadable, points, head.limits, context);
  const Areas whole = read_areas(top, "read_whole", defaults.addressing, context);
  check_whole_areas(whole, unreadable, points, head, context);
  check_broadcast(top, points, head, context);
  check_reserved(reserved, points, context);
  head.security = read_security(top, points, head.service.port, context);
  Joints joints(context);
  const std::vector<Tool> tools = read_tools(top, points, head, joints, context);
  const std::vector<Axis> axes = read_axes(top, points, head, tools, joints, context);
  warn_of_tool_names(points, tools, context);
  if (!tools.empty() || !axes.empty()) warn_of_joint_names(points, context);
  if (problems.has_errors()) return std::nullopt;
  head.unreadable = map.keep(by_place(unreadable));
  head.read_whole = map.keep(by_place(whole));
  head.tools = map.keep(tools);
  head.axes = map.keep(axes);
  return finish(head, points, sim, source.text, defaults.addressing, map);
}

}  // namespace coupler::loader
