// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "coupler/base/span.hpp"
#include "coupler/host/ros/options.hpp"
#include "coupler/host/ros/remapping_check.hpp"

namespace coupler::host {

extern const Dialect ros2_dialect;

struct Arguments : Options {
  std::vector<std::string> for_ros;  ///< the program, "--ros-args" and what follows it
  bool names_the_node = false;       ///< `-r __node:=` is there
};

/// `--key VALUE`, and what is between `--ros-args` and `--` or the end. ROS 1's spelling is a wrong call: the
/// text shows ROS 2's. `arguments[0]` is the program.
Arguments parse_arguments(Span<char* const> arguments);

/// Returns the remappings of topics and services among the arguments for ROS, but those for a node of another
/// name. rcl does not show them.
std::vector<Remapping> remappings_of(const std::vector<std::string>& for_ros, std::string_view node);

/// Returns what to do if rcl refuses arguments with this text, whose last part may be about characters
/// ("lexeme type 19"); empty if the text says it.
std::string_view remedy_of(std::string_view refusal);

}  // namespace coupler::host
