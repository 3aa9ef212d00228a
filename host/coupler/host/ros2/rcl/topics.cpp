// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/ros2/rcl/topics.hpp"

#include <utility>

namespace coupler::rcl {

AnyPublisher::AnyPublisher(Node& node, const rosidl_message_type_support_t* type, const std::string& topic,
                           const rmw_qos_profile_t& qos, Events events)
    : node_(node), publisher_(rcl_get_zero_initialized_publisher()) {
  rcl_publisher_options_t options = rcl_publisher_get_default_options();
  options.qos = qos;
  check(rcl_publisher_init(&publisher_, node.get(), type, topic.c_str(), &options),
        "cannot publish the topic " + topic);
  follow(std::move(events));
}

void AnyPublisher::follow(Events events) {
  if (events.incompatible)
    incompatible_ = std::make_unique<IncompatibleQos>(
        node_.inbox(), publisher_, RCL_PUBLISHER_OFFERED_INCOMPATIBLE_QOS, rcl_publisher_event_init,
        [this, handle = std::move(events.incompatible)](const auto& status) {
          handle(topic(), status.last_policy_kind);
        });
#if COUPLER_RCL_HAS_MATCHED_EVENTS
  if (events.matched)
    matched_ = std::make_unique<Event<rmw_matched_status_t>>(
        node_.inbox(), publisher_, RCL_PUBLISHER_MATCHED, rcl_publisher_event_init,
        [this, handle = std::move(events.matched)](const rmw_matched_status_t& status) {
          const int now = static_cast<int>(status.current_count);
          // Those that have come and gone meanwhile are counted in both.
          const int came = static_cast<int>(status.total_count_change);
          const int gone = subscriptions_ + came - now;
          subscriptions_ = now;
          if (came > 0) handle(came);
          if (gone > 0) handle(-gone);
        });
#else
  // Without the events nobody knows when a subscription goes: every point counts as subscribed.
  if (events.matched) events.matched(1);
#endif
}

AnyPublisher::~AnyPublisher() {
#if COUPLER_RCL_HAS_MATCHED_EVENTS
  matched_.reset();
#endif
  incompatible_.reset();
  ignore(rcl_publisher_fini(&publisher_, node_.get()));
}

void AnyPublisher::publish_any(const void* message) {
  if (rcl_publish(&publisher_, message, nullptr) != RCL_RET_OK)
    node_.log_failure("cannot publish " + topic());
}

AnySubscription::AnySubscription(Node& node, const rosidl_message_type_support_t* type,
                                 const std::string& topic, const rmw_qos_profile_t& qos,
                                 OnIncompatible incompatible)
    : Source(node.inbox()), node_(node), subscription_(rcl_get_zero_initialized_subscription()) {
  rcl_subscription_options_t options = rcl_subscription_get_default_options();
  options.qos = qos;
  check(rcl_subscription_init(&subscription_, node.get(), type, topic.c_str(), &options),
        "cannot subscribe to the topic " + topic);
  ignore(rcl_subscription_options_fini(&options));
  if (incompatible)
    incompatible_ = std::make_unique<IncompatibleQos>(
        node.inbox(), subscription_, RCL_SUBSCRIPTION_REQUESTED_INCOMPATIBLE_QOS, rcl_subscription_event_init,
        [this, handle = std::move(incompatible)](const auto& status) {
          handle(this->topic(), status.last_policy_kind);
        });
}

void AnySubscription::start() {
  check(rcl_subscription_set_on_new_message_callback(&subscription_, note_of, self()),
        "cannot subscribe to the topic " + topic());
}

void AnySubscription::stop() {
  ignore(rcl_subscription_set_on_new_message_callback(&subscription_, nullptr, nullptr));
  leave();
}

AnySubscription::~AnySubscription() {
  incompatible_.reset();
  ignore(rcl_subscription_fini(&subscription_, node_.get()));
}

bool AnySubscription::take_any(void* message) {
  rmw_message_info_t ignored;
  const rcl_ret_t taken = rcl_take(&subscription_, message, &ignored, nullptr);
  if (taken == RCL_RET_OK) return true;
  if (taken == RCL_RET_SUBSCRIPTION_TAKE_FAILED)
    take_error_text();  // there was nothing
  else
    node_.log_failure("cannot read a message of " + topic());
  return false;
}

}  // namespace coupler::rcl
