// SPDX-License-Identifier: Apache-2.0
#include "host/ros/ros_log.hpp"

#include <ros/console.h>

namespace coupler::driver {

void log(Level level, const std::string& text) {
  switch (level) {
    case Level::info: ROS_INFO("%s", text.c_str()); break;
    case Level::warning: ROS_WARN("%s", text.c_str()); break;
    case Level::error: ROS_ERROR("%s", text.c_str()); break;
  }
}

}  // namespace coupler::driver
