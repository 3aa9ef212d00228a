// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "coupler/host/core/value_table.hpp"
#include "coupler/host/motion/tools.hpp"
#include "coupler/map/map.hpp"

namespace coupler::host {

/// The joints of a device: its tools and its axes, the tools first.
class Joints {
 public:
  struct Joint {
    std::string name;
    std::size_t index = 0;         ///< into Map::tools or Map::axes
    const Tool* tool = nullptr;    ///< null: an axis
    const Axis* axis = nullptr;    ///< null: a tool
    const Point* point = nullptr;  ///< of an axis
    std::uint32_t point_index = 0;
  };

  /// The storage of `map`, the table and the tools must outlive it.
  Joints(const Map& map, const ValueTable& values, Tools& tools);

  std::size_t size() const { return joints_.size(); }
  const Joint& operator[](std::size_t joint) const { return joints_[joint]; }
  std::optional<std::size_t> find(std::string_view name) const;
  std::vector<std::string_view> names() const;
  /// Returns the joint that the point drives: an axis, or a tool with that output; nothing if it drives none.
  std::optional<std::size_t> driven_by(std::uint32_t point) const { return drives_[point]; }

  /// Any thread may call it. Returns nothing while the device is offline, or a point has no good value.
  std::optional<JointPosition> position(std::size_t joint, Time now) const;

 private:
  const Map map_;
  const ValueTable& values_;
  Tools& tools_;
  std::vector<Joint> joints_;
  std::vector<std::optional<std::size_t>> drives_;  ///< by point
};

}  // namespace coupler::host
