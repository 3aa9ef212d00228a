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
#include <set>
#include <utility>

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

std::string full_name_of(std::string space, const char* node) {
  if (space != "/") space += '/';
  return space + node;
}

rcl_ret_t end(rcl_context_t* context) {
  ignore(rcl_logging_fini());
  ignore(rcl_shutdown(context));
  return rcl_context_fini(context);
}

/// Those after --ros-args that ROS does not know are an error.
void refuse_unknown(const rcl_arguments_t& parsed, const std::vector<std::string>& arguments) {
  if (rcl_arguments_get_count_unparsed_ros(&parsed) <= 0) return;
  int* indices = nullptr;
  const rcl_allocator_t allocator = rcl_get_default_allocator();
  check(rcl_arguments_get_unparsed_ros(&parsed, allocator, &indices), "cannot read the arguments of ROS 2");
  const std::string& first = arguments[static_cast<std::size_t>(indices[0])];
  allocator.deallocate(indices, allocator.state);
  throw Error(first + ": ROS 2 does not know this argument", RCL_RET_INVALID_ROS_ARGS);
}

}  // namespace

Context::Context(const std::vector<std::string>& arguments)
    : context_(rcl_get_zero_initialized_context(), end) {
  std::vector<const char*> words;
  words.reserve(arguments.size());
  for (const std::string& word : arguments) words.push_back(word.c_str());
  const rcl_allocator_t allocator = rcl_get_default_allocator();
  Handle<rcl_init_options_t> options(rcl_get_zero_initialized_init_options(), rcl_init_options_fini);
  check(rcl_init_options_init(options.get(), allocator), "cannot initialize ROS 2");
  check(rcl_init(static_cast<int>(words.size()), words.data(), options.get(), get()), "cannot start ROS 2");
  check(rcl_logging_configure_with_output_handler(&this->arguments(), &allocator, log_one_at_a_time),
        "cannot start the log of ROS 2");
  refuse_unknown(this->arguments(), arguments);
}

Node::Node(Context& context, const std::string& name)
    : node_(rcl_get_zero_initialized_node(), rcl_node_fini),
      graph_changes_(rcl_get_zero_initialized_wait_set(), rcl_wait_set_fini) {
  const rcl_node_options_t options = rcl_node_get_default_options();
  check(rcl_node_init(get(), name.c_str(), "", context.get(), &options), "cannot make the node " + name);
  check(rcl_wait_set_init(graph_changes_.get(), 0, 1, 0, 0, 0, 0, context.get(), rcl_get_default_allocator()),
        "cannot watch the graph");
  // The log goes to /rosout, too, unless --disable-rosout-logs was given.
#if COUPLER_RCL_LEAVES_ROSOUT_TO_US
  if (rcl_logging_rosout_enabled())
    check(rcl_logging_rosout_init_publisher_for_node(get()), "cannot publish the topic /rosout");
#endif
}

Node::~Node() {
  inbox_.stop();
#if COUPLER_RCL_LEAVES_ROSOUT_TO_US
  if (rcl_logging_rosout_enabled()) ignore(rcl_logging_rosout_fini_publisher_for_node(get()));
#endif
}

void Node::log(int severity, const std::string& text) const {
  static const rcutils_log_location_t here{"coupler_driver", "", 0};
  rcutils_log(&here, severity, rcl_node_get_logger_name(get()), "%s", text.c_str());
}

void Node::log_failure(const std::string& what) {
  const auto line = failures_.say(what + ": " + take_error_text(), std::chrono::steady_clock::now());
  if (line) log(RCUTILS_LOG_SEVERITY_WARN, *line);
}

bool Node::has_taken(rcl_ret_t result, rcl_ret_t nothing, const char* failure, const char* name) {
  if (result == nothing)
    take_error_text();
  else if (result != RCL_RET_OK)
    log_failure(std::string(failure) + name);
  return result == RCL_RET_OK;
}

std::string Node::full_topic(const std::string& name, bool remapped) const {
  char* full = nullptr;
  const rcl_allocator_t allocator = rcl_get_default_allocator();
  check(rcl_node_resolve_name(get(), name.c_str(), allocator, false, !remapped, &full),
        "cannot use the name " + name);
  std::string result = full;
  allocator.deallocate(full, allocator.state);
  return result;
}

bool Node::graph_has_changed() {
  rcl_wait_set_t* const changes = graph_changes_.get();
  rcl_ret_t result = rcl_wait_set_clear(changes);
  if (result == RCL_RET_OK)
    result = rcl_wait_set_add_guard_condition(changes, rcl_node_get_graph_guard_condition(get()), nullptr);
  if (result == RCL_RET_OK) result = rcl_wait(changes, 0);
  if (result != RCL_RET_OK) take_error_text();
  return result != RCL_RET_TIMEOUT;  // after a failure somebody has to look
}

std::vector<std::string> Node::publishers_of(const std::string& full_topic) const {
  std::vector<std::string> nodes;
  rcutils_allocator_t allocator = rcutils_get_default_allocator();
  rcl_topic_endpoint_info_array_t found = rcl_get_zero_initialized_topic_endpoint_info_array();
  if (rcl_get_publishers_info_by_topic(get(), &allocator, full_topic.c_str(), false, &found) != RCL_RET_OK) {
    take_error_text();
    return nodes;
  }
  for (std::size_t i = 0; i < found.size; ++i) {
    const rmw_topic_endpoint_info_t& info = found.info_array[i];
    std::string& node = nodes.emplace_back(full_name_of(info.node_namespace, info.node_name));
    if (node.find("_UNKNOWN_") != std::string::npos) node.clear();
  }
  ignore(rcl_topic_endpoint_info_array_fini(&found, &allocator));
  return nodes;
}

std::vector<Node::End> Node::ends_of_others() const {
  std::vector<End> ends;
  rcutils_string_array_t names = rcutils_get_zero_initialized_string_array();
  rcutils_string_array_t spaces = rcutils_get_zero_initialized_string_array();
  if (rcl_get_node_names(get(), rcl_get_default_allocator(), &names, &spaces) != RCL_RET_OK)
    take_error_text();
  std::set<std::string> seen{full_name()};
  for (std::size_t i = 0; i < names.size; ++i) {
    const std::string node = full_name_of(spaces.data[i], names.data[i]);
    if (!seen.insert(node).second) continue;
    for (const bool publishes : {true, false}) {
      const auto get_ends =
          publishes ? rcl_get_publisher_names_and_types_by_node : rcl_get_subscriber_names_and_types_by_node;
      rcutils_allocator_t allocator = rcutils_get_default_allocator();
      rcl_names_and_types_t found = rcl_get_zero_initialized_names_and_types();
      if (get_ends(get(), &allocator, false, names.data[i], spaces.data[i], &found) != RCL_RET_OK) {
        take_error_text();  // it has gone
        continue;
      }
      for (std::size_t t = 0; t < found.names.size; ++t)
        for (std::size_t k = 0; k < found.types[t].size; ++k)
          ends.push_back({found.names.data[t], node, publishes, found.types[t].data[k]});
      ignore(rcl_names_and_types_fini(&found));
    }
  }
  for (rcutils_string_array_t* const array : {&names, &spaces}) ignore(rcutils_string_array_fini(array));
  return ends;
}

}  // namespace coupler::rcl
