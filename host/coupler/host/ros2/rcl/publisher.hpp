// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <rcl/publisher.h>
#include <rosidl_typesupport_cpp/message_type_support.hpp>

#include <functional>
#include <memory>
#include <string>

#include "coupler/host/ros2/rcl/distro.hpp"
#include "coupler/host/ros2/rcl/event.hpp"
#include "coupler/host/ros2/rcl/node.hpp"

namespace coupler::rcl {

/// A publisher of whichever type.
class AnyPublisher {
 public:
  /// In the inbox's thread; must wait for nothing.
  struct Events {
    std::function<void(int by)> matched{};  ///< so many subscriptions have come, or, negative, gone
    Incompatible incompatible{};
  };

  /// Throws Error.
  AnyPublisher(Node& node, const rosidl_message_type_support_t* type, const std::string& topic,
               const rmw_qos_profile_t& qos, Events events);
  ~AnyPublisher();
  AnyPublisher(const AnyPublisher&) = delete;
  AnyPublisher& operator=(const AnyPublisher&) = delete;

  /// With its namespace, as remapped.
  std::string topic() const { return rcl_publisher_get_topic_name(&publisher_); }

 protected:
  void publish_any(const void* message);

 private:
  void follow(Events events);

  Node& node_;
  rcl_publisher_t publisher_;
  std::unique_ptr<IncompatibleQos> incompatible_;
#if COUPLER_RCL_HAS_MATCHED_EVENTS
  int listeners_ = 0;
  std::unique_ptr<Event<rmw_matched_status_t>> matched_;
#endif
};

/// From one thread at a time.
template <class Message>
class Publisher : public AnyPublisher {
 public:
  Publisher(Node& node, const std::string& topic, const rmw_qos_profile_t& qos, Events events = {})
      : AnyPublisher(node, rosidl_typesupport_cpp::get_message_type_support_handle<Message>(), topic, qos,
                     std::move(events)) {}

  void publish(const Message& message) { publish_any(&message); }
};

}  // namespace coupler::rcl
