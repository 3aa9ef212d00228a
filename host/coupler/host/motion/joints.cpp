// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/motion/joints.hpp"

#include <algorithm>

#include "coupler/host/motion/axis_value.hpp"
#include "coupler/map/joint.hpp"

namespace coupler::host {

Joints::Joints(const Map& map, const ValueTable& values, Tools& tools)
    : map_(map), values_(values), tools_(tools), drives_(map.points.size()) {
  const auto drives = [this](std::string_view output) {
    if (const Point* point = coupler::find(map_, output))  // a tool may have one output only
      drives_[static_cast<std::size_t>(point - map_.points.data())] = joints_.size();
  };
  for (std::size_t i = 0; i < map_.tools.size(); ++i) {
    drives(map_.tools[i].close);
    drives(map_.tools[i].open);
    joints_.push_back({joint_name(map_, map_.tools[i]), i, &map_.tools[i]});
  }
  for (std::size_t i = 0; i < map_.axes.size(); ++i) {
    const Axis& axis = map_.axes[i];
    drives(axis.point);
    const Point* point = coupler::find(map_, axis.point);  // the loader has checked that it is there
    joints_.push_back({joint_name(map_, axis), i, nullptr, &axis, point,
                       static_cast<std::uint32_t>(point - map_.points.data())});
  }
}

std::optional<std::size_t> Joints::find(std::string_view name) const {
  const auto found =
      std::find_if(joints_.begin(), joints_.end(), [name](const Joint& joint) { return joint.name == name; });
  if (found == joints_.end()) return std::nullopt;
  return static_cast<std::size_t>(found - joints_.begin());
}

std::vector<std::string_view> Joints::names() const {
  std::vector<std::string_view> names;
  names.reserve(joints_.size());
  for (const Joint& joint : joints_) names.emplace_back(joint.name);
  return names;
}

std::optional<JointPosition> Joints::position(std::size_t joint, Time now) const {
  const Joint& which = joints_[joint];
  if (which.axis == nullptr) return tools_.position(which.index, now);
  const ValueTable::Value value = values_.get(which.point_index, now);
  if (value.quality.state != PointQuality::State::good || !value.has_value()) return std::nullopt;
  const auto position = position_in(value.registers.data(), *which.axis, *which.point);
  if (!position) return std::nullopt;
  return JointPosition{*position, value.quality.last_good.value_or(value.stamp.at)};
}

}  // namespace coupler::host
