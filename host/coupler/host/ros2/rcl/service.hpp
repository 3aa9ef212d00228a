// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <rcl/service.h>
#include <rosidl_typesupport_cpp/service_type_support.hpp>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "coupler/host/ros2/rcl/error.hpp"
#include "coupler/host/ros2/rcl/node.hpp"

namespace coupler::rcl {

/// A service of any type.
class Service {
 public:
  using RequestId = rmw_request_id_t;

  /// `init` is rcl's function for it. `serve` takes one request, in the inbox's thread; false: there is none.
  /// Throws Error.
  Service(Node& node, std::string name, const std::function<rcl_ret_t(rcl_service_t*)>& init,
          std::function<bool(Service&)> serve);

  bool take(RequestId& id, void* request);
  /// May follow later, from any thread.
  void answer(RequestId id, void* response);

 private:
  Node& node_;
  std::string name_;
  Handle<rcl_service_t> service_;
  std::optional<Inbox::Source> source_;  // last: it uses the others
};

/// Offers a service as long as the result exists. Calls `answer` by `run`, which is called in the inbox's
/// thread and may do that later, in another one. Throws Error.
template <class S>
std::shared_ptr<void> offer(
    Node& node, const std::string& name,
    std::function<void(const typename S::Request&, typename S::Response&)> answer,
    std::function<void(std::function<void()>)> run = [](const auto& call) { call(); }) {
  const auto init = [&](rcl_service_t* service) {
    const rcl_service_options_t options = rcl_service_get_default_options();
    return rcl_service_init(service, node.get(), rosidl_typesupport_cpp::get_service_type_support_handle<S>(),
                            name.c_str(), &options);
  };
  return std::make_shared<Service>(node, name, init,
                                   [answer = std::move(answer), run = std::move(run)](Service& service) {
                                     typename S::Request request;
                                     Service::RequestId id;
                                     if (!service.take(id, &request)) return false;
                                     run([&service, answer, request = std::move(request), id] {
                                       typename S::Response response;
                                       answer(request, response);
                                       service.answer(id, &response);
                                     });
                                     return true;
                                   });
}

/// `~/get_type_description`, where rcl has it. It is offered as long as the result exists. Throws Error.
std::shared_ptr<void> offer_type_descriptions(Node& node);

}  // namespace coupler::rcl
