// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <exception>
#include <string>
#include <system_error>

namespace coupler {

/// Returns the text of an exception. If std::thread threw it because no thread could be started, the text
/// says what to do about that.
inline std::string what_failed(const std::exception& error) {
  const auto* of_system = dynamic_cast<const std::system_error*>(&error);
  if (of_system == nullptr || of_system->code() != std::errc::resource_unavailable_try_again)
    return error.what();
  return "no thread can be started: " + of_system->code().message() +
         "; look at its limits (ulimit -u, TasksMax= of a service)";
}

/// The same of any exception.
inline std::string what_failed(const std::exception_ptr& thrown) {
  try {
    std::rethrow_exception(thrown);
  } catch (const std::exception& error) {
    return what_failed(error);
  } catch (...) {
    return "an exception of an unknown type";
  }
}

}  // namespace coupler
