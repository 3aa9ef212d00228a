// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <rcl/types.h>

#include <stdexcept>
#include <string>

namespace coupler::rcl {

/// What could not be made at the start, and why.
class Error : public std::runtime_error {
 public:
  Error(const std::string& what, rcl_ret_t result);
  rcl_ret_t result() const { return result_; }

 private:
  rcl_ret_t result_;
};

/// The text that rcl has for the last failure in this thread, in one line; it is forgotten then.
std::string take_error_text();

/// Of what is taken down there is nothing to be done about a failure.
void ignore(rcl_ret_t result);

/// Throws where `result` is a failure; `what`: "cannot make the node press_driver".
void check(rcl_ret_t result, const std::string& what);

}  // namespace coupler::rcl
