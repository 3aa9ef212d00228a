// SPDX-License-Identifier: Apache-2.0
#include "coupler/docs/axis_description.hpp"

#include <fmt/format.h>

#include "coupler/map/joint.hpp"

namespace coupler::docs {
namespace {

/// "on", "running", "3"
std::string value_text(const Point* point, std::int64_t value) {
  if (point == nullptr) return fmt::to_string(value);
  if (is_single_bit(*point)) return value == 0 ? "off" : "on";
  for (const NamedValue& named : point->values)
    if (named.value == value) return std::string(named.name);
  return fmt::to_string(value);
}

std::string positions_text(const Map& map, const Axis& axis) {
  if (axis.positions.empty()) return "the published value";
  const Point* point = find(map, axis.point);
  std::string text;
  for (const auto& [value, position] : axis.positions)
    text += fmt::format("{}{} at {}", text.empty() ? "" : ", ", value_text(point, value), position);
  return text;
}

}  // namespace

std::vector<AxisDescription> describe_axes(const Map& map) {
  std::vector<AxisDescription> out;
  for (const Axis& axis : map.axes)
    out.push_back(
        {std::string(axis.name), std::string(axis.point), joint_name(map, axis), positions_text(map, axis)});
  return out;
}

}  // namespace coupler::docs
