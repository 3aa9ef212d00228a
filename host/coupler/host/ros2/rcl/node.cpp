// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/ros2/rcl/node.hpp"

#include <rcl/graph.h>
#include <rcl/init.h>
#include <rcl/init_options.h>
#include <rcl/logging.h>
#include <rcl/logging_rosout.h>
#include <rcutils/logging.h>

#include <cstdarg>
#include <mutex>

#include "coupler/host/ros2/rcl/distro.hpp"
#include "coupler/host/ros2/rcl/error.hpp"

namespace coupler::rcl {
namespace {

/// Only one thread at a time may call rcl's handler of log lines.
void log_one_at_a_time(const rcutils_log_location_t* location, int severity, const char* name,
                       rcutils_time_point_value_t timestamp, const char* format, va_list* arguments) {
  static std::mutex& mutex = *new std::mutex;  // never destroyed: used at the end of the program, too
  const std::lock_guard lock(mutex);
  rcl_logging_multiple_output_handler(location, severity, name, timestamp, format, arguments);
}

/// rcl_init() copies them.
class InitOptions {
 public:
  InitOptions() : options_(rcl_get_zero_initialized_init_options()) {
    check(rcl_init_options_init(&options_, rcl_get_default_allocator()), "cannot initialize ROS 2");
  }
  ~InitOptions() { ignore(rcl_init_options_fini(&options_)); }
  InitOptions(const InitOptions&) = delete;
  InitOptions& operator=(const InitOptions&) = delete;
  const rcl_init_options_t* get() const { return &options_; }

 private:
  rcl_init_options_t options_;
};

}  // namespace

Context::Context(const std::vector<std::string>& arguments)
    : given_(arguments), context_(rcl_get_zero_initialized_context()) {
  std::vector<const char*> words;
  words.reserve(given_.size());
  for (const std::string& word : given_) words.push_back(word.c_str());
  const InitOptions options;
  check(rcl_init(static_cast<int>(words.size()), words.data(), options.get(), &context_),
        "cannot start ROS 2");
  const rcl_allocator_t allocator = rcl_get_default_allocator();
  check(rcl_logging_configure_with_output_handler(&context_.global_arguments, &allocator, log_one_at_a_time),
        "cannot start the log of ROS 2");
}

Context::~Context() {
  ignore(rcl_logging_fini());
  ignore(rcl_shutdown(&context_));
  ignore(rcl_context_fini(&context_));
}

std::vector<std::string> Context::unknown_arguments() const {
  std::vector<std::string> unknown;
  const int count = rcl_arguments_get_count_unparsed_ros(&context_.global_arguments);
  if (count <= 0) return unknown;
  int* indices = nullptr;
  const rcl_allocator_t allocator = rcl_get_default_allocator();
  check(rcl_arguments_get_unparsed_ros(&context_.global_arguments, allocator, &indices),
        "cannot read the arguments of ROS 2");
  for (int i = 0; i < count; ++i) unknown.push_back(given_[static_cast<std::size_t>(indices[i])]);
  allocator.deallocate(indices, allocator.state);
  return unknown;
}

Node::Node(Context& context, const std::string& name) : node_(rcl_get_zero_initialized_node()) {
  const rcl_node_options_t options = rcl_node_get_default_options();
  check(rcl_node_init(&node_, name.c_str(), "", context.get(), &options), "cannot make the node " + name);
  // The log goes to /rosout, too, unless --disable-rosout-logs was given.
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
