// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/ros2/rcl/subscription.hpp"

#include <utility>
#include "coupler/host/ros2/rcl/error.hpp"

namespace coupler::rcl {

AnySubscription::AnySubscription(Node& node, const rosidl_message_type_support_t* type,
                                 const std::string& topic, const rmw_qos_profile_t& qos,
                                 Incompatible incompatible)
    : Source(node.inbox()), node_(node), subscription_(rcl_get_zero_initialized_subscription()) {
  rcl_subscription_options_t options = rcl_subscription_get_default_options();
  options.qos = qos;
  check(rcl_subscription_init(&subscription_, node.get(), type, topic.c_str(), &options),
        "cannot subscribe to the topic " + topic);
  ignore(rcl_subscription_options_fini(&options));
  if (incompatible)
    incompatible_ = std::make_unique<IncompatibleQos>(
        node.inbox(), subscription_, RCL_SUBSCRIPTION_REQUESTED_INCOMPATIBLE_QOS, rcl_subscription_event_init,
        [this, tell = std::move(incompatible)](const auto& status) {
          tell(this->topic(), status.last_policy_kind);
        });
}

void AnySubscription::listen() {
  check(rcl_subscription_set_on_new_message_callback(&subscription_, note_of, self()),
        "cannot subscribe to the topic " + topic());
}

void AnySubscription::end() {
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
