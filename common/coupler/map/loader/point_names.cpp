// SPDX-License-Identifier: Apache-2.0
#include "coupler/map/loader/point_names.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "coupler/map/nearest.hpp"

namespace coupler::loader {

PointNames::PointNames(const DraftPoints& points) {
  for (const DraftPoint& draft : points) points_.emplace(draft.point.name, &draft);
}

const DraftPoint* PointNames::get(std::string_view name) const {
  const auto found = points_.find(name);
  return found == points_.end() ? nullptr : found->second;
}

const DraftPoint* PointNames::find(std::string_view name, Position at,
                                   const std::function<bool(const Point&)>& is_meant,
                                   std::string_view expected, const Context& context) const {
  if (const DraftPoint* found = get(name)) return found;
  std::vector<std::string_view> names;
  for (const auto& [each, draft] : points_)
    if (is_meant(draft->point)) names.push_back(each);
  std::sort(names.begin(), names.end());
  context.problems.error(at, fmt::format("no point is called {}", shown(name)),
                         nearest_or(name, names, fmt::format("write the name of {}", expected)));
  return nullptr;
}

const Entry* PointNames::check(const Reader& reader, std::string_view key, const Eligible& eligible,
                               const Context& context) const {
  const Entry* value = reader.find(key);
  if (value == nullptr || value->kind != Entry::Kind::scalar) return nullptr;  // a problem already
  const DraftPoint* draft = find(value->text, value->at, eligible.is_meant, eligible.expected, context);
  if (draft == nullptr || !draft->placed) return nullptr;
  auto hindrance = eligible.why_not(*draft);
  if (!hindrance) return value;
  context.problems.error(value->at, fmt::format("{} {}", shown(value->text), hindrance->what),
                         std::move(hindrance->remedy));
  return nullptr;
}

const Point* PointNames::find(std::string_view name, Table table, Position at, std::string remedy,
                              const Context& context) const {
  const std::string_view expected = table == Table::coils ? "a coil" : "a discrete input";
  const auto is_in_table = [table](const Point& point) { return point.table == table; };
  const DraftPoint* found = find(name, at, is_in_table, expected, context);
  if (found == nullptr || is_in_table(found->point)) return found == nullptr ? nullptr : &found->point;
  context.problems.error(
      at, fmt::format("{} is in {}, not {}", shown(name), to_string(found->point.table), expected),
      std::move(remedy));
  return nullptr;
}

}  // namespace coupler::loader
