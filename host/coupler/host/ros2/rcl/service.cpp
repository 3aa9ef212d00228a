// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/ros2/rcl/service.hpp"

#include "coupler/host/ros2/rcl/distro.hpp"
#include "coupler/host/ros2/rcl/error.hpp"

namespace coupler::rcl {

AnyService::AnyService(Node& node, const rosidl_service_type_support_t* type, const std::string& name)
    : Source(node.inbox()), node_(node), name_(name), service_(rcl_get_zero_initialized_service()) {
  const rcl_service_options_t options = rcl_service_get_default_options();
  check(rcl_service_init(&service_, node.get(), type, name.c_str(), &options),
        "cannot offer the service " + name);
}

void AnyService::start() {
  check(rcl_service_set_on_new_request_callback(&service_, note_of, self()),
        "cannot offer the service " + name_);
}

void AnyService::stop() {
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

#if COUPLER_RCL_HAS_TYPE_DESCRIPTIONS
namespace {

/// rcl answers by itself, with its C messages.
class TypeDescriptions : public Inbox::Source {
 public:
  explicit TypeDescriptions(Node& node)
      : Source(node.inbox()), node_(node), service_(rcl_get_zero_initialized_service()) {
    check(rcl_node_type_description_service_init(&service_, node.get()),
          "cannot offer the service ~/get_type_description");
    check(rcl_service_set_on_new_request_callback(&service_, note_of, self()),
          "cannot offer the service ~/get_type_description");
  }
  ~TypeDescriptions() override {
    ignore(rcl_service_set_on_new_request_callback(&service_, nullptr, nullptr));
    leave();
    ignore(rcl_service_fini(&service_, node_.get()));
  }

 protected:
  bool take() override {
    type_description_interfaces__srv__GetTypeDescription_Request request;
    type_description_interfaces__srv__GetTypeDescription_Response response{};  // rcl initializes it
    type_description_interfaces__srv__GetTypeDescription_Request__init(&request);
    rmw_request_id_t id;
    const bool taken = rcl_take_request(&service_, &id, &request) == RCL_RET_OK;
    if (taken) rcl_node_type_description_service_handle_request(node_.get(), &id, &request, &response);
    if (!taken || rcl_send_response(&service_, &id, &response) != RCL_RET_OK) take_error_text();
    type_description_interfaces__srv__GetTypeDescription_Request__fini(&request);
    type_description_interfaces__srv__GetTypeDescription_Response__fini(&response);
    return taken;
  }

 private:
  Node& node_;
  rcl_service_t service_;
};

}  // namespace

std::shared_ptr<void> offer_type_descriptions(Node& node) { return std::make_shared<TypeDescriptions>(node); }
#else
std::shared_ptr<void> offer_type_descriptions(Node& /*node*/) { return nullptr; }
#endif

}  // namespace coupler::rcl
