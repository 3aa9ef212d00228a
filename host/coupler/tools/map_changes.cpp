// SPDX-License-Identifier: Apache-2.0
#include "coupler/tools/map_changes.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <unordered_map>
#include <utility>

#include <fmt/format.h>

#include "coupler/map/diff.hpp"
#include "coupler/map/fields.hpp"
#include "coupler/tools/map_details.hpp"

namespace coupler::tools {
namespace {

/// The fields of canonical_line() but the name, by which points are matched.
constexpr std::array<std::pair<std::string_view, std::string_view>, 11> rules{{
    {"table", "table-changed"},
    {"address", "address-moved"},
    {"part", "part-moved"},
    {"type", "type-changed"},
    {"order", "order-changed"},
    {"count", "count-changed"},
    {"length", "length-changed"},
    {"encoding", "encoding-changed"},
    {"ignore_byteorder", "ignore-byteorder-changed"},
    {"scale", "scale-changed"},
    {"access", "access-changed"},
}};

std::string rule_of(std::string_view field) {
  const auto* const found =
      std::find_if(rules.begin(), rules.end(), [field](const auto& rule) { return rule.first == field; });
  return std::string(found->second);
}

void add_contract(const Difference& difference, std::vector<Change>& changes) {
  const Severity severity = is_breaking(difference.kind) ? Severity::breaking : Severity::compatible;
  switch (difference.kind) {
    case Difference::Kind::missing:
      changes.push_back({"point-removed", severity, difference.point, difference.what, {}});
      return;
    case Difference::Kind::added:
      changes.push_back({"point-added", severity, difference.point, {}, difference.what});
      return;
    case Difference::Kind::changed:
      for (const auto& [field, older, newer] : difference.fields)
        changes.push_back({rule_of(field), severity, difference.point, older, newer});
      return;
  }
}

/// Zero of a number with a unit means that there is none, for example no rate of its own.
template <class Key, class Value>
std::string text_of(const Key& field, const Value& value) {
  if constexpr (std::is_same_v<Value, double>)
    if (value == Bounds::no_min || value == Bounds::no_max) return "none";
  if (field.unit.empty()) return written(value);
  return value == Value{} ? std::string() : fmt::format("{} {}", written(value), field.unit);
}
template <class Key, class Rep, class Period>
std::string text_of(const Key& /*field*/, std::chrono::duration<Rep, Period> value) {
  return value.count() == 0 ? "none" : written(value);
}

/// Returns whether a rule names a key, as "queue-size-changed" names `queue_size`.
bool names(std::string_view rule, std::string_view key) {
  std::string own(key);
  std::replace(own.begin(), own.end(), '_', '-');
  return rule.find(own) != std::string_view::npos;
}

/// Adds the changes of the fields. Neighbouring keys that have the same rule become one change.
template <class Struct>
void add_fields(const Struct& older, const Struct& newer, std::string_view point,
                std::vector<Change>& changes) {
  const std::size_t first = changes.size();
  for_each_field(older, newer, [&](const auto& field, const auto& before, const auto& now) {
    if (before == now) return;
    const bool is_named = names(field.change, field.key);
    const auto told = [&](const auto& value) {
      const std::string text = text_of(field, value);
      return is_named ? text : fmt::format("{} {}", field.key, text.empty() ? "none" : text);
    };
    std::string from = told(before);
    std::string to = told(now);
    if (changes.size() > first && changes.back().rule == field.change) {
      changes.back().older += ", " + from;
      changes.back().newer += ", " + to;
    } else {
      changes.push_back({std::string(field.change), Severity::compatible, std::string(point), std::move(from),
                         std::move(to)});
    }
  });
}

void add_all_fields(const Map& older, const Map& newer, std::vector<Change>& changes) {
  add_fields(older.connection, newer.connection, {}, changes);
  add_fields(older.polling, newer.polling, {}, changes);
  add_fields(older.limits, newer.limits, {}, changes);
  add_fields(older, newer, {}, changes);
  add_fields(older.service, newer.service, {}, changes);
  const auto has_two_ports = [](const Map& map) {
    return map.connection.tls.present() && map.service.port != map.connection.port;
  };
  if (older.service.port != newer.service.port && (has_two_ports(older) || has_two_ports(newer)))
    changes.push_back({"connection-changed", Severity::compatible, "",
                       fmt::format("port {} without TLS", older.service.port),
                       fmt::format("port {} without TLS", newer.service.port)});
  add_fields(older.service.watchdog, newer.service.watchdog, {}, changes);
}

template <class Described>
void add_details(const Described& older, const Described& newer, std::string_view point,
                 std::vector<Change>& changes) {
  auto a = details_of(older);
  auto b = details_of(newer);
  for (std::size_t i = 0; i < a.size(); ++i)
    if (a[i].value != b[i].value)
      changes.push_back({std::string(a[i].rule), a[i].severity, std::string(point), std::move(a[i].value),
                         std::move(b[i].value)});
}

template <class Key, class Element, class KeyOf>
std::unordered_map<Key, const Element*> indexed(Span<const Element> elements, KeyOf key_of) {
  std::unordered_map<Key, const Element*> index;
  for (const Element& element : elements) index.emplace(key_of(element), &element);
  return index;
}

/// Adds the changes of the tools or the axes, which are matched by name. `one`: "tool".
template <class ToolOrAxis>
void add_named(std::string_view one, Span<const ToolOrAxis> older, Span<const ToolOrAxis> newer,
               std::vector<Change>& changes) {
  const auto name_of = [](const ToolOrAxis& each) { return each.name; };
  const auto old_ones = indexed<std::string_view>(older, name_of);
  const auto new_ones = indexed<std::string_view>(newer, name_of);
  constexpr Severity severity = Severity::compatible;
  for (const ToolOrAxis& each : older) {
    if (const auto found = new_ones.find(each.name); found != new_ones.end())
      add_fields(each, *found->second, each.name, changes);
    else
      changes.push_back(
          {fmt::format("{}-removed", one), severity, std::string(each.name), described(each), {}});
  }
  for (const ToolOrAxis& each : newer)
    if (old_ones.count(each.name) == 0)
      changes.push_back(
          {fmt::format("{}-added", one), severity, std::string(each.name), {}, described(each)});
}

using PointsByName = std::unordered_map<std::string_view, const Point*>;

/// All but what the fingerprint contains.
void add_rest(const Point& older, const Point& newer, std::vector<Change>& changes) {
  add_details(older, newer, older.name, changes);
  add_fields(older.bounds, newer.bounds, older.name, changes);
  add_fields(older.faults, newer.faults, older.name, changes);
  add_fields(older.host, newer.host, older.name, changes);
}

bool is_same_place(const Point& a, const Point& b) {
  return a.table == b.table && a.address == b.address && a.format.type == b.format.type &&
         codec::mask(a.format) == codec::mask(b.format);
}

/// Points of the old map that are gone, by name, each with the new one that stands where it stood.
using Renamed = std::unordered_map<std::string_view, const Point*>;
Renamed find_renamed(const Map& older, const Map& newer, const PointsByName& old_points,
                     const PointsByName& new_points) {
  Renamed renamed;
  for (const Point& gone : older.points) {
    if (new_points.count(gone.name) != 0) continue;
    for (const Point& point : newer.points)
      if (is_same_place(gone, point) && old_points.count(point.name) == 0) renamed.emplace(gone.name, &point);
  }
  return renamed;
}

/// The rest of what the fingerprint contains may have changed together with the name.
void add_renamed(const Point& older, const Point& newer, std::vector<Change>& changes) {
  changes.push_back({"point-renamed", Severity::breaking, std::string(older.name), std::string(older.name),
                     std::string(newer.name)});
  Point same_name = newer;
  same_name.name = older.name;
  Map before;
  Map now;
  before.points = {&older, 1};
  now.points = {&same_name, 1};
  for (const Difference& difference : diff(before, now)) add_contract(difference, changes);
  add_rest(older, newer, changes);
}

}  // namespace

std::vector<Change> compare(const Map& older, const Map& newer) {
  std::vector<Change> changes;
  add_details(older, newer, {}, changes);
  add_all_fields(older, newer, changes);
  add_named("tool", older.tools, newer.tools, changes);
  add_named("axis", older.axes, newer.axes, changes);
  const std::vector<Difference> contract = diff(older, newer);
  const auto differences = indexed<std::string_view>(
      Span<const Difference>(contract), [](const Difference& d) -> std::string_view { return d.point; });
  const auto name_of = [](const Point& point) { return point.name; };
  const PointsByName new_points = indexed<std::string_view>(newer.points, name_of);
  const Renamed renamed =
      find_renamed(older, newer, indexed<std::string_view>(older.points, name_of), new_points);
  for (const Point& point : older.points) {
    if (const auto found = renamed.find(point.name); found != renamed.end()) {
      add_renamed(point, *found->second, changes);
      continue;
    }
    if (const auto found = differences.find(point.name); found != differences.end())
      add_contract(*found->second, changes);
    if (const auto found = new_points.find(point.name); found != new_points.end())
      add_rest(point, *found->second, changes);
  }
  const auto is_new_name = [&](const Difference& added) {
    return std::any_of(renamed.begin(), renamed.end(),
                       [&](const auto& pair) { return pair.second->name == added.point; });
  };
  for (const Difference& difference : contract)
    if (difference.kind == Difference::Kind::added && !is_new_name(difference))
      add_contract(difference, changes);
  return changes;
}

std::optional<Severity> worst(const std::vector<Change>& changes) {
  if (changes.empty()) return std::nullopt;
  return std::min_element(changes.begin(), changes.end(),
                          [](const Change& a, const Change& b) { return a.severity < b.severity; })
      ->severity;
}

}  // namespace coupler::tools
