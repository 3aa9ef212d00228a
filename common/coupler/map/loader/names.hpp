// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>
#include <vector>

#include "coupler/map/loader/draft_point.hpp"
#include "coupler/map/loader/reader.hpp"

namespace coupler::loader {

/// A relative ROS graph name: a letter, then letters, digits, '_' and single '/' that do not end it.
bool is_relative_ros_name(std::string_view name);

/// Topics of the driver itself, beside those of the points: no point may have such a name.
constexpr std::string_view driver_topics[] = {"online", "scheduled", "status"};
/// Names added later. A point may have one of them; then the driver does not serve its own.
constexpr std::string_view points_topic = "points";
constexpr std::string_view wait_for_action = "wait_for";  ///< an action, if the map has that key
bool is_driver_topic(std::string_view name);

/// The map's name is a namespace.
void check_map_name(std::string_view name, Position at, const Context& context);

/// Points' names are ROS names, unique across the tables, and do not clash with the driver's own topics.
/// `has_wait_for`: the driver is to serve that action.
void check_point_names(const DraftPoints& points, bool has_wait_for, const Context& context);

/// Warns of points that take the place of what the driver serves for each of the tools.
void warn_of_tool_names(const DraftPoints& points, const std::vector<Tool>& tools, const Context& context);

/// Warns of points that take the place of what it serves for all tools and axes together.
void warn_of_joint_names(const DraftPoints& points, const Context& context);

}  // namespace coupler::loader
