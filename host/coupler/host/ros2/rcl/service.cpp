// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/ros2/rcl/service.hpp"

#include "coupler/host/ros2/rcl/error.hpp"

namespace coupler::rcl {

AnyService::AnyService(Node& node, const rosidl_service_type_support_t* type, const std::string& name)
    : Source(node.inbox()), node_(node), name_(name), service_(rcl_get_zero_initialized_service()) {
  const rcl_service_options_t options = rcl_service_get_default_options();
  check(rcl_service_init(&service_, node.get(), type, name.c_str(), &options),
        "cannot offer the service " + name);
}

void AnyService::listen() {
  check(rcl_service_set_on_new_request_callback(&service_, note_of, self()),
        "cannot offer the service " + name_);
}

void AnyService::end() {
  ignore(rcl_service_set_on_new_request_callback(&service_, nullptr, nullptr));
  leave();
}

AnyService::~AnyService() { ignore(rcl_service_fini(&service_, node_.get())); }

bool AnyService::take_any(RequestId& id, void* request) {
  const rcl_ret_t taken = rcl_take_request(&service_, &id, request);
  if (taken == RCL_RET_OK) return true;
  if (taken == RCL_RET_SERVICE_TAKE_FAILED)
    take_error_text();  // there was nothing
  else
    node_.log_failure("cannot read a call of " + name_);
  return false;
}

void AnyService::answer_any(RequestId& id, void* response) {
  if (rcl_send_response(&service_, &id, response) != RCL_RET_OK)
    node_.log_failure("cannot answer a call of " + name_);
}

}  // namespace coupler::rcl
