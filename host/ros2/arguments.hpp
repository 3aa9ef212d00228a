// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/base/span.hpp"
#include "host/ros/dialect.hpp"
#include "host/ros/settings.hpp"

namespace coupler::driver {

extern const Dialect ros2_dialect;

struct Arguments {
  Settings settings;
  std::vector<std::string> for_ros;  ///< the program, "--ros-args" and what follows it
  bool names_the_node = false;       ///< `-r __node:=` is there
  std::optional<int> exit_code;      ///< the program is to end: 0 after --help, 2 after a wrong call
  std::string text;                  ///< then: what to print, to stdout or stderr
};

/// `--key VALUE`, and what stands between `--ros-args` and `--` or the end. What is spelled as in ROS 1 is a
/// wrong call, told with ROS 2's spelling. `arguments[0]` is the program.
Arguments parse_arguments(Span<char* const> arguments);

}  // namespace coupler::driver
