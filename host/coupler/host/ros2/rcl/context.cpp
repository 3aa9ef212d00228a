// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/ros2/rcl/context.hpp"

#include <rcl/init.h>
#include <rcl/init_options.h>
#include <rcl/logging.h>

#include <cstdarg>
#include <mutex>

#include "coupler/host/ros2/rcl/error.hpp"

namespace coupler::rcl {
namespace {

/// rcl's handler of log lines may be called by one thread at a time only.
void log_one_at_a_time(const rcutils_log_location_t* location, int severity, const char* name,
                       rcutils_time_point_value_t timestamp, const char* format, va_list* arguments) {
  static std::mutex& mutex = *new std::mutex;  // at the end of the program, too
  const std::lock_guard lock(mutex);
  rcl_logging_multiple_output_handler(location, severity, name, timestamp, format, arguments);
}

/// They are copied by rcl_init().
class InitOptions {
 public:
  InitOptions() : options_(rcl_get_zero_initialized_init_options()) {
    check(rcl_init_options_init(&options_, rcl_get_default_allocator()), "cannot begin with ROS 2");
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
        "ROS 2 does not start");
  const rcl_allocator_t allocator = rcl_get_default_allocator();
  check(rcl_logging_configure_with_output_handler(&context_.global_arguments, &allocator, log_one_at_a_time),
        "cannot set up the log");
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
        "cannot read the arguments");
  for (int i = 0; i < count; ++i) unknown.push_back(given_[static_cast<std::size_t>(indices[i])]);
  allocator.deallocate(indices, allocator.state);
  return unknown;
}

}  // namespace coupler::rcl
