// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <rcl/error_handling.h>
#include <rcl/rcl.h>
#include <rosidl_typesupport_cpp/message_type_support.hpp>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <string>

namespace bench {

/// SIGINT or SIGTERM came.
inline volatile std::sig_atomic_t ended = 0;

inline void check(rcl_ret_t result) {
  if (result == RCL_RET_OK) return;
  std::fprintf(stderr, "%s\n", rcl_get_error_string().str);
  std::exit(1);
}

/// A node of plain rcl, and what is made in it: reliable, volatile, keep last 10, as the driver's topics.
class Session {
 public:
  explicit Session(const char* name) {
    rcl_init_options_t options = rcl_get_zero_initialized_init_options();
    check(rcl_init_options_init(&options, rcl_get_default_allocator()));
    check(rcl_init(0, nullptr, &options, &context_));
    check(rcl_init_options_fini(&options));
    const rcl_node_options_t node_options = rcl_node_get_default_options();
    check(rcl_node_init(&node_, name, "", &context_, &node_options));
    for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, [](int) { ended = 1; });
  }
  ~Session() {
    check(rcl_node_fini(&node_));
    check(rcl_shutdown(&context_));
    check(rcl_context_fini(&context_));
  }
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  rcl_context_t* context() { return &context_; }

  template <class M>
  rcl_publisher_t publish(const std::string& topic) {
    const rcl_publisher_options_t options = rcl_publisher_get_default_options();
    rcl_publisher_t publisher = rcl_get_zero_initialized_publisher();
    const auto* type = rosidl_typesupport_cpp::get_message_type_support_handle<M>();
    check(rcl_publisher_init(&publisher, &node_, type, topic.c_str(), &options));
    return publisher;
  }
  void end(rcl_publisher_t& publisher) { check(rcl_publisher_fini(&publisher, &node_)); }

  template <class M>
  rcl_subscription_t subscribe(const std::string& topic) {
    const rcl_subscription_options_t options = rcl_subscription_get_default_options();
    rcl_subscription_t subscription = rcl_get_zero_initialized_subscription();
    const auto* type = rosidl_typesupport_cpp::get_message_type_support_handle<M>();
    check(rcl_subscription_init(&subscription, &node_, type, topic.c_str(), &options));
    return subscription;
  }
  void end(rcl_subscription_t& subscription) { check(rcl_subscription_fini(&subscription, &node_)); }

 private:
  rcl_context_t context_ = rcl_get_zero_initialized_context();
  rcl_node_t node_ = rcl_get_zero_initialized_node();
};

}  // namespace bench
