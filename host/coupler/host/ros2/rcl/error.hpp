// SPDX-License-Identifier: Apache-2.0
// What calls of rcl return, and the structs that they begin and end.
#pragma once

#include <rcl/error_handling.h>
#include <rcl/types.h>

#include <algorithm>
#include <functional>
#include <stdexcept>
#include <string>
#include <utility>

namespace coupler::rcl {

/// The text that rcl has for the last failure in this thread, in one line. rcl forgets it.
inline std::string take_error_text() {
  std::string text = rcl_error_is_set() ? rcl_get_error_string().str : "unknown reason";
  rcl_reset_error();
  // ", at /path/of/the/build/machine/file.c:123" helps nobody here.
  text.resize(std::min(text.size(), text.find(", at ")));
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

/// Thrown if something could not be made at the start. The text says what, and why.
class Error : public std::runtime_error {
 public:
  Error(const std::string& text, rcl_ret_t result) : std::runtime_error(text), result_(result) {}
  rcl_ret_t result() const { return result_; }

 private:
  rcl_ret_t result_;
};

/// Throws if `result` is a failure; `what`: "cannot make the node press_driver".
inline void check(rcl_ret_t result, const std::string& what) {
  if (result != RCL_RET_OK) throw Error(what + ": " + take_error_text(), result);
}

/// Used by destructors, which can do nothing about a failure.
inline void ignore(rcl_ret_t result) {
  if (result != RCL_RET_OK) rcl_reset_error();
}

/// A struct of rcl, which `fini` ends. rcl takes one that was never initialized, too.
template <class T>
class Handle {
 public:
  Handle(T zero, std::function<rcl_ret_t(T*)> fini) : value_(zero), fini_(std::move(fini)) {}
  ~Handle() { ignore(fini_(&value_)); }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;

  T* get() { return &value_; }
  const T* get() const { return &value_; }

 private:
  T value_;
  std::function<rcl_ret_t(T*)> fini_;
};

}  // namespace coupler::rcl
