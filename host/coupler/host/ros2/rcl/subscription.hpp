// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <rcl/subscription.h>
#include <rosidl_typesupport_cpp/message_type_support.hpp>

#include <functional>
#include <memory>
#include <string>

#include "coupler/host/ros2/rcl/event.hpp"
#include "coupler/host/ros2/rcl/node.hpp"

namespace coupler::rcl {

/// A subscription of whichever type.
class AnySubscription : public Inbox::Source {
 public:
  /// Throws Error.
  AnySubscription(Node& node, const rosidl_message_type_support_t* type, const std::string& topic,
                  const rmw_qos_profile_t& qos, Incompatible incompatible);

  std::string topic() const { return rcl_subscription_get_topic_name(&subscription_); }

 protected:
  ~AnySubscription() override;
  /// From now on take() is called.
  void listen();
  void end();
  bool take_any(void* message);

 private:
  Node& node_;
  rcl_subscription_t subscription_;
  std::unique_ptr<IncompatibleQos> incompatible_;
};

template <class Message>
class Subscription : public AnySubscription {
 public:
  /// `receive` is called in the inbox's thread.
  Subscription(Node& node, const std::string& topic, const rmw_qos_profile_t& qos,
               std::function<void(const Message&)> receive, Incompatible incompatible = {})
      : AnySubscription(node, rosidl_typesupport_cpp::get_message_type_support_handle<Message>(), topic, qos,
                        std::move(incompatible)),
        receive_(std::move(receive)) {
    listen();
  }
  ~Subscription() override { end(); }

 protected:
  bool take() override {
    if (!take_any(&message_)) return false;
    receive_(message_);
    return true;
  }

 private:
  std::function<void(const Message&)> receive_;
  Message message_;  ///< keeps its memory from message to message
};

}  // namespace coupler::rcl
