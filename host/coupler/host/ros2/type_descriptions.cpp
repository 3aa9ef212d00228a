// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/ros2/type_descriptions.hpp"

#include "coupler/host/ros2/rcl/distro.hpp"

#if COUPLER_RCL_HAS_TYPE_DESCRIPTIONS
#include <rcl/service.h>

#include "coupler/host/ros2/rcl/error.hpp"

namespace coupler::host {
namespace {

/// rcl answers by itself, with its messages for C.
class TypeDescriptions : public rcl::Inbox::Source {
 public:
  explicit TypeDescriptions(rcl::Node& node)
      : Source(node.inbox()), node_(node), service_(rcl_get_zero_initialized_service()) {
    rcl::check(rcl_node_type_description_service_init(&service_, node.get()),
               "cannot offer the service ~/get_type_description");
    rcl::check(rcl_service_set_on_new_request_callback(&service_, note_of, self()),
               "cannot offer the service ~/get_type_description");
  }
  ~TypeDescriptions() override {
    rcl::ignore(rcl_service_set_on_new_request_callback(&service_, nullptr, nullptr));
    leave();
    rcl::ignore(rcl_service_fini(&service_, node_.get()));
  }

 protected:
  bool take() override {
    type_description_interfaces__srv__GetTypeDescription_Request request;
    type_description_interfaces__srv__GetTypeDescription_Response response{};  // rcl makes it
    type_description_interfaces__srv__GetTypeDescription_Request__init(&request);
    rmw_request_id_t id;
    const bool taken = rcl_take_request(&service_, &id, &request) == RCL_RET_OK;
    if (taken) rcl_node_type_description_service_handle_request(node_.get(), &id, &request, &response);
    if (!taken || rcl_send_response(&service_, &id, &response) != RCL_RET_OK) rcl::take_error_text();
    type_description_interfaces__srv__GetTypeDescription_Request__fini(&request);
    type_description_interfaces__srv__GetTypeDescription_Response__fini(&response);
    return taken;
  }

 private:
  rcl::Node& node_;
  rcl_service_t service_;
};

}  // namespace

std::shared_ptr<void> offer_type_descriptions(rcl::Node& node) {
  return std::make_shared<TypeDescriptions>(node);
}

}  // namespace coupler::host
#else
namespace coupler::host {

std::shared_ptr<void> offer_type_descriptions(rcl::Node& /*node*/) { return nullptr; }

}  // namespace coupler::host
#endif
