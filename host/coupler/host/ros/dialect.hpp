// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace coupler::host {

/// What the driver's texts say differently in ROS 1 and in ROS 2. What both understand, `--key VALUE`, needs
/// none.
struct Dialect {
  std::string_view help;            ///< the last lines of --help
  std::string_view device_setting;  ///< how a setting of one device of several is given
  std::string_view relative_path;   ///< with a path that leads nowhere: where a launch starts programs
};

}  // namespace coupler::host
