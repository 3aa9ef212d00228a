// SPDX-License-Identifier: Apache-2.0
// Publishers and subscriptions, their QoS and their events.
#pragma once

#include <rcl/publisher.h>
#include <rmw/qos_profiles.h>
#include <rosidl_typesupport_cpp/message_type_support.hpp>

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "coupler/host/ros2/rcl/error.hpp"
#include "coupler/host/ros2/rcl/node.hpp"

namespace coupler::rcl {

/// Reliable, volatile, the last `depth` messages.
inline rmw_qos_profile_t reliable(std::size_t depth) {
  rmw_qos_profile_t qos = rmw_qos_profile_default;
  qos.depth = depth;
  return qos;
}

/// A late subscriber that requests transient local gets the last message at once.
inline rmw_qos_profile_t latched() {
  rmw_qos_profile_t qos = reliable(1);
  qos.durability = RMW_QOS_POLICY_DURABILITY_TRANSIENT_LOCAL;
  return qos;
}

/// Returns the QoS of /clock.
inline rmw_qos_profile_t best_effort(std::size_t depth) {
  rmw_qos_profile_t qos = reliable(depth);
  qos.reliability = RMW_QOS_POLICY_RELIABILITY_BEST_EFFORT;
  return qos;
}

/// Called for a publisher or subscriber whose QoS does not fit: the topic, with its namespace, and a policy,
/// as "durability".
using OnIncompatible = std::function<void(const std::string& topic, const std::string& policy)>;

/// The events of a publisher. The inbox's thread makes the calls, and they must not wait for anything.
struct PublisherEvents {
  std::function<void(bool came)> matched{};  ///< a subscription has come, or gone
  OnIncompatible incompatible{};
};

/// A publisher of any type.
class AnyPublisher {
 public:
  /// Throws Error.
  AnyPublisher(Node& node, const rosidl_message_type_support_t* type, const std::string& topic,
               const rmw_qos_profile_t& qos, PublisherEvents events);

  std::string topic() const { return rcl_publisher_get_topic_name(publisher_.get()); }
  void publish(const void* message);

 private:
  Node& node_;
  Handle<rcl_publisher_t> publisher_;
  std::vector<std::shared_ptr<void>> events_;  // last: they use the publisher
};

/// Copies are the same publisher. For one thread at a time.
template <class Message>
class Publisher {
 public:
  /// Publishes nothing, and must not be asked to.
  Publisher() = default;
  /// Throws Error.
  Publisher(Node& node, const std::string& topic, const rmw_qos_profile_t& qos, PublisherEvents events = {})
      : publisher_(std::make_shared<AnyPublisher>(
            node, rosidl_typesupport_cpp::get_message_type_support_handle<Message>(), topic, qos,
            std::move(events))) {}

  void publish(const Message& message) const { publisher_->publish(&message); }
  /// With its namespace, as remapped.
  std::string topic() const { return publisher_->topic(); }

 private:
  std::shared_ptr<AnyPublisher> publisher_;
};

/// `receive` is called when there is something in `message`.
struct Receiver {
  void* message;
  std::function<void()> receive;
};

/// subscribe() to any type.
std::shared_ptr<void> subscribe_any(Node& node, const rosidl_message_type_support_t* type,
                                    const std::string& topic, const rmw_qos_profile_t& qos, Receiver receiver,
                                    OnIncompatible incompatible);

/// Calls `receive` in the inbox's thread, as long as the result exists. Throws Error.
template <class Message>
std::shared_ptr<void> subscribe(Node& node, const std::string& topic, const rmw_qos_profile_t& qos,
                                std::function<void(const Message&)> receive,
                                OnIncompatible incompatible = {}) {
  const auto message = std::make_shared<Message>();  // keeps its memory from message to message
  return subscribe_any(node, rosidl_typesupport_cpp::get_message_type_support_handle<Message>(), topic, qos,
                       {message.get(), [message, receive = std::move(receive)] { receive(*message); }},
                       std::move(incompatible));
}

}  // namespace coupler::rcl
