// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/ros2/rcl/service.hpp"

#include "coupler/host/ros2/rcl/distro.hpp"

namespace coupler::rcl {

Service::Service(Node& node, std::string name, const std::function<rcl_ret_t(rcl_service_t*)>& init,
                 std::function<bool(Service&)> serve)
    : node_(node),
      name_(std::move(name)),
      service_(rcl_get_zero_initialized_service(),
               [&node](auto* service) { return rcl_service_fini(service, node.get()); }) {
  const std::string failure = "cannot offer the service " + name_;
  check(init(service_.get()), failure);
  source_.emplace(
      node.inbox(), service_.get(), rcl_service_set_on_new_request_callback,
      [this, serve = std::move(serve)] { return serve(*this); }, failure);
}

bool Service::take(RequestId& id, void* request) {
  return node_.has_taken(rcl_take_request(service_.get(), &id, request), RCL_RET_SERVICE_TAKE_FAILED,
                         "cannot read a call of ", name_.c_str());
}

void Service::answer(RequestId id, void* response) {
  if (rcl_send_response(service_.get(), &id, response) != RCL_RET_OK)
    node_.log_failure("cannot answer a call of " + name_);
}

/// rcl answers by itself, with its C messages.
std::shared_ptr<void> offer_type_descriptions([[maybe_unused]] Node& node) {
#if COUPLER_RCL_HAS_TYPE_DESCRIPTIONS
  const auto init = [&](rcl_service_t* service) {
    return rcl_node_type_description_service_init(service, node.get());
  };
  return std::make_shared<Service>(node, "~/get_type_description", init, [&node](Service& service) {
    type_description_interfaces__srv__GetTypeDescription_Request request;
    type_description_interfaces__srv__GetTypeDescription_Response response{};  // rcl initializes it
    type_description_interfaces__srv__GetTypeDescription_Request__init(&request);
    Service::RequestId id;
    const bool taken = service.take(id, &request);
    if (taken) {
      rcl_node_type_description_service_handle_request(node.get(), &id, &request, &response);
      service.answer(id, &response);
    }
    type_description_interfaces__srv__GetTypeDescription_Request__fini(&request);
    type_description_interfaces__srv__GetTypeDescription_Response__fini(&response);
    return taken;
  });
#else
  return nullptr;
#endif
}

}  // namespace coupler::rcl
