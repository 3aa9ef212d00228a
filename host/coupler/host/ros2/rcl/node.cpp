// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/ros2/rcl/node.hpp"

#include <rcl/graph.h>
#include <rcl/logging.h>
#include <rcl/logging_rosout.h>
#include <rcutils/logging.h>

#include "coupler/host/ros2/rcl/distro.hpp"
#include "coupler/host/ros2/rcl/error.hpp"

namespace coupler::rcl {

Node::Node(Context& context, const std::string& name) : node_(rcl_get_zero_initialized_node()) {
  const rcl_node_options_t options = rcl_node_get_default_options();
  check(rcl_node_init(&node_, name.c_str(), "", context.get(), &options), "cannot make the node " + name);
  // What is logged goes to /rosout, too, unless --disable-rosout-logs is there.
#if COUPLER_RCL_LEAVES_ROSOUT_TO_US
  if (rcl_logging_rosout_enabled())
    check(rcl_logging_rosout_init_publisher_for_node(&node_), "cannot publish the topic /rosout");
#endif
}

Node::~Node() {
  inbox_.stop();
#if COUPLER_RCL_LEAVES_ROSOUT_TO_US
  if (rcl_logging_rosout_enabled()) ignore(rcl_logging_rosout_fini_publisher_for_node(&node_));
#endif
  ignore(rcl_node_fini(&node_));
}

void Node::log(int severity, const std::string& text) const {
  static const rcutils_log_location_t here{"coupler_driver", "", 0};
  rcutils_log(&here, severity, rcl_node_get_logger_name(&node_), "%s", text.c_str());
}

void Node::log_failure(const std::string& what) {
  const auto line = failures_.say(what + ": " + take_error_text(), std::chrono::steady_clock::now());
  if (line) log(RCUTILS_LOG_SEVERITY_WARN, *line);
}

std::vector<std::string> Node::publishers_of(const std::string& full_topic) const {
  std::vector<std::string> nodes;
  rcutils_allocator_t allocator = rcutils_get_default_allocator();
  rcl_topic_endpoint_info_array_t found = rcl_get_zero_initialized_topic_endpoint_info_array();
  if (rcl_get_publishers_info_by_topic(&node_, &allocator, full_topic.c_str(), false, &found) != RCL_RET_OK) {
    take_error_text();
    return nodes;
  }
  for (std::size_t i = 0; i < found.size; ++i) {
    std::string space = found.info_array[i].node_namespace;
    if (space != "/") space += '/';
    nodes.push_back(space + found.info_array[i].node_name);
  }
  ignore(rcl_topic_endpoint_info_array_fini(&found, &allocator));
  return nodes;
}

}  // namespace coupler::rcl
