// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/ros2/rcl/publisher.hpp"

#include <utility>
#include "coupler/host/ros2/rcl/error.hpp"

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
        [this, tell = std::move(events.incompatible)](const auto& status) {
          tell(topic(), status.last_policy_kind);
        });
#if COUPLER_RCL_HAS_MATCHED_EVENTS
  if (events.matched)
    matched_ = std::make_unique<Event<rmw_matched_status_t>>(
        node_.inbox(), publisher_, RCL_PUBLISHER_MATCHED, rcl_publisher_event_init,
        [this, tell = std::move(events.matched)](const rmw_matched_status_t& status) {
          const int now = static_cast<int>(status.current_count);
          // Who has come and gone meanwhile has come, too.
          const int came = static_cast<int>(status.total_count_change);
          const int gone = listeners_ + came - now;
          listeners_ = now;
          if (came > 0) tell(came);
          if (gone > 0) tell(-gone);
        });
#else
  // Without the events nobody knows when a subscription goes: all points count as listened to.
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

}  // namespace coupler::rcl
