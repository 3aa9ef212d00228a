// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <rcl/service.h>
#include <rosidl_typesupport_cpp/service_type_support.hpp>

#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "coupler/host/ros2/rcl/node.hpp"

namespace coupler::rcl {

/// A service of any type.
class AnyService : public Inbox::Source {
 public:
  using RequestId = rmw_request_id_t;

  /// Throws Error.
  AnyService(Node& node, const rosidl_service_type_support_t* type, const std::string& name);

 protected:
  ~AnyService() override;
  /// take() is called from now on.
  void start();
  void stop();
  bool take_any(RequestId& id, void* request);
  void answer_any(RequestId& id, void* response);

 private:
  Node& node_;
  std::string name_;
  rcl_service_t service_;
};

template <class S>
class Service : public AnyService {
 public:
  using Request = typename S::Request;
  using Response = typename S::Response;

  /// `call` is called in the inbox's thread; answer() may follow later, from any thread.
  Service(Node& node, const std::string& name, std::function<void(const Request&, RequestId)> call)
      : AnyService(node, rosidl_typesupport_cpp::get_service_type_support_handle<S>(), name),
        call_(std::move(call)) {
    start();
  }
  ~Service() override { stop(); }

  void answer(RequestId id, Response& response) { answer_any(id, &response); }

 protected:
  bool take() override {
    Request request;
    RequestId id;
    if (!take_any(id, &request)) return false;
    call_(request, id);
    return true;
  }

 private:
  std::function<void(const Request&, RequestId)> call_;
};

/// A service that is answered at once, in the inbox's thread.
template <class S>
class PromptService : public Service<S> {
 public:
  using Request = typename S::Request;
  using Response = typename S::Response;

  PromptService(Node& node, const std::string& name, std::function<void(const Request&, Response&)> answer)
      : Service<S>(node, name,
                   [this, answer = std::move(answer)](const Request& request, AnyService::RequestId id) {
                     Response response;
                     answer(request, response);
                     this->answer(id, response);
                   }) {}
};

/// `~/get_type_description`, where rcl has it. It is offered as long as the result exists. Throws Error.
std::shared_ptr<void> offer_type_descriptions(Node& node);

}  // namespace coupler::rcl
