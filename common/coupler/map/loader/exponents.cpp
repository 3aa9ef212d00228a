// SPDX-License-Identifier: Apache-2.0
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include <fmt/format.h>

#include "coupler/codec/scale.hpp"
#include "coupler/map/loader/point_reader.hpp"
#include "coupler/map/nearest.hpp"

namespace coupler::loader {
namespace {

/// Empty, or why the point's value cannot be an exponent.
std::string why_no_exponent(const Point& point) {
  if (holds_bits(point.table) || !codec::is_scalable(point.format.type) || codec::is_float(point.format.type))
    return fmt::format("has the type {}", to_string(point.format.type));
  if (point.scale.present()) return "has a scale of its own";
  if (point.count > 1) return "is an array";
  if (!is_readable(point)) return "can only be written";
  return {};
}

struct Wrong {
  std::string_view what;
  std::string_view remedy;
};

/// Why the point's scale cannot have an exponent.
std::optional<Wrong> why_not_scaled(const Point& point) {
  if (point.count > 1) return Wrong{"is an array", "write one point for each value"};
  if (is_writable(point))
    return Wrong{
        "can be written",
        "add 'access: read', and write the raw value through a second point at the same address with "
        "'access: write'"};
  if (has_hardware(point))
    return Wrong{"belongs to hardware of the node", "remove the key of the hardware, or 'exponent_of'"};
  return std::nullopt;
}

}  // namespace

void check_exponents(const DraftPoints& points, const Context& context) {
  std::unordered_map<std::string_view, const DraftPoint*> by_name;
  for (const DraftPoint& draft : points) by_name.emplace(draft.point.name, &draft);
  std::vector<std::string_view> names;  // made when it is needed
  for (const DraftPoint& draft : points) {
    const Point& point = draft.point;
    if (!point.scale.has_exponent() || context.problems.is_full()) continue;
    const Position at = draft.options.find("scale")->at;
    const std::string_view name = point.scale.exponent_of;
    const auto found = by_name.find(name);
    if (const auto wrong = why_not_scaled(point); wrong) {
      context.problems.error(
          at, fmt::format("{} {}, so its scale cannot have 'exponent_of'", shown(point.name), wrong->what),
          std::string(wrong->remedy));
    } else if (found == by_name.end()) {
      if (names.empty())
        for (const DraftPoint& each : points)
          if (why_no_exponent(each.point).empty()) names.push_back(each.point.name);
      context.problems.error(at, fmt::format("no point is called {}", shown(name)),
                             nearest_or(name, names, "write the name of the point that holds the exponent"));
    } else if (const std::string why = why_no_exponent(found->second->point);
               !why.empty() && found->second->placed) {
      context.problems.error(at, fmt::format("{} {}, so it cannot be an exponent", shown(name), why),
                             "name a point that is one integer without 'scale', such as an INT");
    }
  }
}

}  // namespace coupler::loader
