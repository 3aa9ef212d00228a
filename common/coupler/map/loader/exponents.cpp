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

/// Empty, or why the point's value can be no power of ten.
std::string why_no_exponent(const Point& point) {
  if (holds_bits(point.table) || !codec::is_scalable(point.format.type) || codec::is_float(point.format.type))
    return fmt::format("is a {}", to_string(point.format.type));
  if (point.scale.present()) return "has a scale itself";
  if (point.count > 1) return "is an array";
  if (!is_readable(point)) return "can only be written";
  return {};
}

struct Wrong {
  std::string_view what;
  std::string_view remedy;
};

/// Why the point's scale cannot have a power of ten.
std::optional<Wrong> why_not_scaled(const Point& point) {
  if (point.count > 1) return Wrong{"is an array", "write one point for each value"};
  if (is_writable(point))
    return Wrong{"can be written",
                 "add 'access: read'; write the raw value by another point at the same address"};
  if (has_hardware(point)) return Wrong{"has hardware of the node", "remove the one or the other"};
  return std::nullopt;
}

}  // namespace

void check_exponents(const DraftPoints& points, const Context& context) {
  std::unordered_map<std::string_view, const Point*> by_name;
  for (const DraftPoint& draft : points) by_name.emplace(draft.point.name, &draft.point);
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
      context.problems.error(
          at, fmt::format("no point is called {}", shown(name)),
          nearest_or(name, names, "write the name of the point that has the power of ten"));
    } else if (const std::string why = why_no_exponent(*found->second); !why.empty()) {
      context.problems.error(at, fmt::format("{} {}, so it has no power of ten", shown(name), why),
                             "name a point that is a single whole number without a scale, as INT");
    }
  }
}

}  // namespace coupler::loader
