// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/ros1/ros_log.hpp"

#include <ros/console.h>
#include <ros/init.h>

#include <cstdio>

#include <fmt/format.h>

#include "coupler/map/printable.hpp"

namespace coupler::host {
namespace {

// One function each: a macro of ROS unfolds to a page.
void info(const std::string& text) { ROS_INFO("%s", text.c_str()); }
void warn(const std::string& text) { ROS_WARN("%s", text.c_str()); }
void error(const std::string& text) { ROS_ERROR("%s", text.c_str()); }

}  // namespace

void ros_log(Level level, const std::string& raw) {
  const std::string text = printable_lines(raw);
  if (ros::isShuttingDown()) {  // its log has ended; what becomes of safe values is still to be told
    fmt::print(stderr, "[{}] {}\n",
               level == Level::error     ? "ERROR"
               : level == Level::warning ? " WARN"
                                         : " INFO",
               text);
    return;
  }
  switch (level) {
    case Level::info: return info(text);
    case Level::warning: return warn(text);
    case Level::error: return error(text);
  }
}

bool is_debug_logged() {
  ROSCONSOLE_DEFINE_LOCATION(true, ros::console::levels::Debug, ROSCONSOLE_DEFAULT_NAME);
  return __rosconsole_define_location__enabled;
}

void ros_log_debug(const std::string& text) { ROS_DEBUG("%s", printable_lines(text).c_str()); }

}  // namespace coupler::host
