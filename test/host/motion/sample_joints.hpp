// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "coupler/host/motion/joints.hpp"
#include "coupler/host/motion/trajectory_plan.hpp"
#include "test/fakes/map_builder.hpp"
#include "test/host/motion/sample_tools.hpp"

namespace coupler::host {

/// A device with the tool clamp, and with the axes glue (off 0, on 1), mode (idle 0, slow 1, fast 4) and
/// speed (a number); its values can be set.
class SampleJoints : public SampleDevice {
 protected:
  SampleJoints() : SampleDevice(make_map()) { tools.on_online(true, now()); }

  void read(std::string_view name, std::uint16_t value) { read_for(tools, name, value); }
  /// A goal of one joint: its positions at 0, 1, 2 … seconds.
  static TrajectoryGoal goal(const std::string& joint, const std::vector<double>& positions) {
    TrajectoryGoal goal;
    goal.joints = {joint};
    for (std::size_t i = 0; i < positions.size(); ++i)
      goal.points.push_back({{positions[i]}, std::chrono::seconds(i)});
    return goal;
  }
  tl::expected<TrajectoryPlan, TrajectoryError> plan(const TrajectoryGoal& goal) {
    return plan_trajectory(goal, joints);
  }

  std::vector<Write> tool_writes;
  Tools tools{map->map(),
              values,
              now(),
              {[this](const Write& write) { tool_writes.push_back(write); }, [](std::uint32_t) {}, [] {},
               [](std::size_t, const ToolStatus&) {}}};
  Joints joints{map->map(), values, tools};

 private:
  static MapPtr make_map() {
    static const Tool tools_of_map[] = {[] {
      Tool tool = clamp();
      tool.joint = "clamp";
      return tool;
    }()};
    static constexpr AxisPosition switched[] = {{0, 0}, {1, 1}};
    static constexpr AxisPosition modes[] = {{0, 0}, {7, 1}, {2, 4}};
    static constexpr Axis axes[] = {{"glue", "valve_glue", "glue", switched},
                                    {"mode", "mode", "mode", modes},
                                    {"speed", "speed", "speed"},
                                    {"force", "force", "force"}};
    fakes::MapBuilder builder;
    builder.coil("valve_close", 0).coil("valve_open", 1).coil("valve_glue", 8);
    builder.input("sensor_closed", 0).input("sensor_open", 1);
    builder.holding("mode", 0).holding("speed", 1).holding("force", 2, codec::Type::REAL);
    builder.head().tools = tools_of_map;
    builder.head().axes = axes;
    return builder.build();
  }
};

}  // namespace coupler::host
