// SPDX-License-Identifier: Apache-2.0
// Publishers and subscriptions, their QoS and their events.
#pragma once

#include <rcl/event.h>
#include <rcl/publisher.h>
#include <rcl/subscription.h>
#include <rmw/incompatible_qos_events_statuses.h>
#include <rmw/qos_profiles.h>
#include <rosidl_typesupport_cpp/message_type_support.hpp>

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "coupler/host/ros2/rcl/distro.hpp"
#include "coupler/host/ros2/rcl/error.hpp"
#include "coupler/host/ros2/rcl/inbox.hpp"
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

/// As of /clock.
inline rmw_qos_profile_t best_effort(std::size_t depth) {
  rmw_qos_profile_t qos = reliable(depth);
  qos.reliability = RMW_QOS_POLICY_RELIABILITY_BEST_EFFORT;
  return qos;
}

/// An event of a publisher or a subscription, with the middleware's Status. With a middleware that does not
/// support it, it never happens.
template <class Status>
class Event : public Inbox::Source {
 public:
  /// `entity`: an rcl_publisher_t or rcl_subscription_t, which must outlive it; `init`: rcl's function for
  /// it.
  template <class Entity, class Type>
  Event(Inbox& inbox, const Entity& entity, Type type, rcl_ret_t (*init)(rcl_event_t*, const Entity*, Type),
        std::function<void(const Status&)> handle)
      : Source(inbox), event_(rcl_get_zero_initialized_event()), handle_(std::move(handle)) {
    const rcl_ret_t made = init(&event_, &entity, type);
    if (made == RCL_RET_UNSUPPORTED) {
      take_error_text();
      return;
    }
    check(made, "cannot receive the events of a topic");
    supported_ = true;
    check(rcl_event_set_callback(&event_, note_of, self()), "cannot receive the events of a topic");
  }
  ~Event() override {
    if (supported_) ignore(rcl_event_set_callback(&event_, nullptr, nullptr));
    leave();
    if (supported_) ignore(rcl_event_fini(&event_));
  }

 protected:
  bool take() override {
    Status status{};
    if (rcl_take_event(&event_, &status) != RCL_RET_OK) {
      take_error_text();
      return false;
    }
    handle_(status);
    return false;  // one status holds all that has happened
  }

 private:
  rcl_event_t event_;
  std::function<void(const Status&)> handle_;
  bool supported_ = false;
};

/// Called for a publisher or subscriber whose QoS does not fit: the topic, with its namespace, and a policy.
using OnIncompatible = std::function<void(const std::string& topic, rmw_qos_policy_kind_t)>;
using IncompatibleQos = Event<rmw_qos_incompatible_event_status_t>;

/// A publisher of any type.
class AnyPublisher {
 public:
  /// Called in the inbox's thread; must not wait for anything.
  struct Events {
    std::function<void(int by)> matched{};  ///< how many subscriptions have come, or, negative, gone
    OnIncompatible incompatible{};
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
  int subscriptions_ = 0;
  std::unique_ptr<Event<rmw_matched_status_t>> matched_;
#endif
};

/// For one thread at a time.
template <class Message>
class Publisher : public AnyPublisher {
 public:
  Publisher(Node& node, const std::string& topic, const rmw_qos_profile_t& qos, Events events = {})
      : AnyPublisher(node, rosidl_typesupport_cpp::get_message_type_support_handle<Message>(), topic, qos,
                     std::move(events)) {}

  void publish(const Message& message) { publish_any(&message); }
};

/// A subscription of any type.
class AnySubscription : public Inbox::Source {
 public:
  /// Throws Error.
  AnySubscription(Node& node, const rosidl_message_type_support_t* type, const std::string& topic,
                  const rmw_qos_profile_t& qos, OnIncompatible incompatible);

  std::string topic() const { return rcl_subscription_get_topic_name(&subscription_); }

 protected:
  ~AnySubscription() override;
  /// take() is called from now on.
  void start();
  void stop();
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
               std::function<void(const Message&)> receive, OnIncompatible incompatible = {})
      : AnySubscription(node, rosidl_typesupport_cpp::get_message_type_support_handle<Message>(), topic, qos,
                        std::move(incompatible)),
        receive_(std::move(receive)) {
    start();
  }
  ~Subscription() override { stop(); }

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
