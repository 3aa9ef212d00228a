// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <system_error>

namespace coupler {

/// What std::thread throws when there is none to be had, and what to do about it.
inline std::string thread_shortage(const std::system_error& error) {
  return "no thread can be started: " + error.code().message() +
         "; look at its limits (ulimit -u, TasksMax= of a service)";
}

}  // namespace coupler
