// SPDX-License-Identifier: Apache-2.0
#include "common/map/loader/map_reader.hpp"

#include <algorithm>
#include <tuple>

#include <fmt/format.h>

#include "common/map/loader/edge_reader.hpp"
#include "common/map/loader/names.hpp"
#include "common/map/loader/overlap.hpp"
#include "common/map/loader/point_reader.hpp"
#include "common/map/loader/preset.hpp"
#include "common/map/loader/rules.hpp"
#include "common/map/loader/service_reader.hpp"
#include "common/map/loader/settings_reader.hpp"
#include "common/map/loader/sim_reader.hpp"
#include "common/map/loader/unreadable_reader.hpp"

namespace coupler::loader {
namespace {

std::string_view read_name(const Reader& top, const Entry& root, Context& context) {
  std::string_view name;
  const std::size_t errors = context.problems.errors();
  top.text("name", name);
  if (const Entry* entry = top.find("name")) {
    if (context.problems.errors() == errors) check_map_name(name, entry->at, context);
  } else {
    context.problems.error(root.at, "the map has no 'name'", "add 'name: NAME', the namespace of its topics");
  }
  return name;
}

PointDefaults read_point_defaults(const Reader& top, Context& context) {
  PointDefaults defaults;
  bool bytes_reversed = false;
  bool most_significant_first = false;
  top.choice("addressing", {Addressing::zero_based, Addressing::modicon}, defaults.addressing);
  top.boolean("byteorder_reverse", bytes_reversed);
  top.boolean("wordorder_reverse", most_significant_first);
  defaults.order = codec::make_order(!most_significant_first, bytes_reversed);
  defaults.host = read_host_defaults(top, context);
  return defaults;
}

void read_table(const Entry& entry, Table table, const PointDefaults& defaults, DraftPoints& points,
                Context& context) {
  const std::string expected = fmt::format("'{}' holds points", to_string(table));
  if (!check_map(entry, expected, "write one 'name: …' a point below it", context)) return;
  for (const Entry& point : entry.children) points.push_back(read_point(point, table, defaults, context));
}

/// In the order of the file.
DraftPoints read_points(const Reader& top, const Entry& root, const PointDefaults& defaults,
                        Context& context) {
  DraftPoints points;
  const Entry* mapping = top.find("mapping");
  if (mapping == nullptr) {
    context.problems.error(root.at, "the map has no 'mapping'",
                           "add 'mapping:' with the tables and their points");
    return points;
  }
  if (!check_map(*mapping, "'mapping' holds the tables", "write 'coils:', 'holding_registers:' … below it",
                 context))
    return points;
  const Reader reader(*mapping, Section::mapping, context);
  for (const Table table : tables)
    if (const Entry* entry = reader.find(to_string(table)))
      read_table(*entry, table, defaults, points, context);
  std::stable_sort(points.begin(), points.end(), [](const DraftPoint& a, const DraftPoint& b) {
    return std::tie(a.name_at.line, a.name_at.column) < std::tie(b.name_at.line, b.name_at.column);
  });
  return points;
}

void check_points(const DraftPoints& points, const Limits& limits, bool addressing_given, Context& context) {
  check_point_names(points, context);
  check_overlaps(points, context);
  check_lines(points, context);
  check_sizes(points, limits, context);
  if (!addressing_given) warn_of_modicon_numbers(points, context);
}

}  // namespace

void read_map(const Entry& file, std::string_view text, Context& context) {
  if (file.kind != Entry::Kind::map) {
    context.problems.error(file.at, fmt::format("a map of a coupler has keys, this is {}", shown(file)),
                           "begin with 'name: NAME'");
    return;
  }
  context.only_origin = has_only_origin_keys(file);
  const auto preset = read_preset(file, context);
  const Entry root = preset ? completed(file, *preset) : file;
  const Reader top(root, Section::map, context);
  Map head;
  head.name = read_name(top, root, context);
  head.connection = read_connection(top);
  head.polling = read_polling(top);
  head.limits = read_limits(top, context);
  head.service = read_service(top, context);
  const PointDefaults defaults = read_point_defaults(top, context);
  DraftPoints drafts = read_points(top, root, defaults, context);
  if (preset) apply(*preset, drafts, context);
  check_points(drafts, head.limits, top.has("addressing"), context);
  std::vector<SimWire> sim = read_sim(top, drafts, context);
  check_edges(drafts, sim, context);
  head.unreadable = context.map.keep(read_unreadable(top, drafts, defaults.addressing, context));
  top.choice("on_reconnect", {OnReconnect::drop, OnReconnect::restore}, head.on_reconnect);
  top.choice("on_shutdown", {OnShutdown::hold, OnShutdown::safe}, head.on_shutdown);
  if (context.problems.has_errors()) return;

  std::vector<Point> points;
  points.reserve(drafts.size());
  for (const DraftPoint& draft : drafts) points.push_back(draft.point);
  head.text = context.map.keep(std::string(text));
  context.map.finish(head, std::move(points), std::move(sim));
}

}  // namespace coupler::loader
