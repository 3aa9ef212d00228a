// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/ros2/rcl/error.hpp"

#include <rcl/error_handling.h>

#include <algorithm>

namespace coupler::rcl {

std::string take_error_text() {
  std::string text = rcl_error_is_set() ? rcl_get_error_string().str : "no reason is known";
  rcl_reset_error();
  // ", at /path/of/the/build/machine/file.c:123" helps nobody here.
  text.resize(std::min(text.size(), text.find(", at ")));
  for (char& sign : text)
    if (sign == '\n') sign = ' ';
  return text;
}

Error::Error(const std::string& what, rcl_ret_t result)
    : std::runtime_error(what + ": " + take_error_text()), result_(result) {}

void ignore(rcl_ret_t result) {
  if (result != RCL_RET_OK) rcl_reset_error();
}

void check(rcl_ret_t result, const std::string& what) {
  if (result != RCL_RET_OK) throw Error(what, result);
}

}  // namespace coupler::rcl
