// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <rcl/context.h>

#include <string>
#include <vector>

namespace coupler::rcl {

/// ROS 2 in this process, with its arguments and its logging. There is one in a process.
class Context {
 public:
  /// `arguments`: the program, "--ros-args" and what follows. Throws Error.
  explicit Context(const std::vector<std::string>& arguments);
  ~Context();
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  rcl_context_t* get() { return &context_; }
  const rcl_arguments_t& arguments() const { return context_.global_arguments; }
  /// Behind --ros-args, and nothing that ROS knows.
  std::vector<std::string> unknown_arguments() const;

 private:
  std::vector<std::string> given_;
  rcl_context_t context_;
};

}  // namespace coupler::rcl
