// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <rcl/event.h>
#include <rmw/incompatible_qos_events_statuses.h>

#include <functional>
#include <string>
#include <utility>

#include "coupler/host/ros2/rcl/error.hpp"
#include "coupler/host/ros2/rcl/inbox.hpp"

namespace coupler::rcl {

/// An event of a publisher or a subscription, with the middleware's Status. A middleware that does not know
/// it never tells.
template <class Status>
class Event : public Inbox::Source {
 public:
  /// `entity`: an rcl_publisher_t or rcl_subscription_t, which must outlive it; `init`: rcl's function for
  /// it.
  template <class Entity, class Type>
  Event(Inbox& inbox, const Entity& entity, Type type, rcl_ret_t (*init)(rcl_event_t*, const Entity*, Type),
        std::function<void(const Status&)> tell)
      : Source(inbox), event_(rcl_get_zero_initialized_event()), tell_(std::move(tell)) {
    const rcl_ret_t made = init(&event_, &entity, type);
    if (made == RCL_RET_UNSUPPORTED) {
      take_error_text();
      return;
    }
    check(made, "cannot follow the events of a topic");
    known_ = true;
    check(rcl_event_set_callback(&event_, note_of, self()), "cannot follow the events of a topic");
  }
  ~Event() override {
    if (known_) ignore(rcl_event_set_callback(&event_, nullptr, nullptr));
    leave();
    if (known_) ignore(rcl_event_fini(&event_));
  }

 protected:
  bool take() override {
    Status status{};
    if (rcl_take_event(&event_, &status) != RCL_RET_OK) {
      take_error_text();
      return false;
    }
    tell_(status);
    return false;  // one status holds all that has happened
  }

 private:
  rcl_event_t event_;
  std::function<void(const Status&)> tell_;
  bool known_ = false;
};

/// Is told of another end of a topic with a QoS that does not fit: the topic, with its namespace, and a
/// policy.
using Incompatible = std::function<void(const std::string& topic, rmw_qos_policy_kind_t)>;
using IncompatibleQos = Event<rmw_qos_incompatible_event_status_t>;

}  // namespace coupler::rcl
