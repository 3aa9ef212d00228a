// SPDX-License-Identifier: Apache-2.0
#include "common/changes/changes.hpp"

#include <algorithm>
#include <array>
#include <unordered_map>
#include <utility>

#include "common/changes/details.hpp"
#include "common/map/diff.hpp"

namespace coupler::changes {
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

}  // namespace

std::vector<Change> compare(const Map& older, const Map& newer) {
  std::vector<Change> changes;
  add_details(older, newer, {}, changes);
  const std::vector<Difference> contract = diff(older, newer);
  const auto differences = indexed<std::string_view>(
      Span<const Difference>(contract), [](const Difference& d) -> std::string_view { return d.point; });
  const auto points = indexed<std::string_view>(newer.points, [](const Point& point) { return point.name; });
  for (const Point& point : older.points) {
    if (const auto found = differences.find(point.name); found != differences.end())
      add_contract(*found->second, changes);
    if (const auto found = points.find(point.name); found != points.end())
      add_details(point, *found->second, point.name, changes);
  }
  for (const Difference& difference : contract)
    if (difference.kind == Difference::Kind::added) add_contract(difference, changes);
  return changes;
}

std::optional<Severity> worst(const std::vector<Change>& changes) {
  if (changes.empty()) return std::nullopt;
  return std::min_element(changes.begin(), changes.end(),
                          [](const Change& a, const Change& b) { return a.severity < b.severity; })
      ->severity;
}

}  // namespace coupler::changes
