// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <rcl_interfaces/msg/parameter.hpp>
#include <rcl_interfaces/msg/parameter_descriptor.hpp>
#include <rcl_interfaces/msg/parameter_event.hpp>
#include <rcl_interfaces/msg/set_parameters_result.hpp>

#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "coupler/host/ros2/message_clock.hpp"
#include "coupler/host/ros2/rcl/node.hpp"
#include "coupler/host/ros2/rcl/topics.hpp"

namespace coupler::host {

/// The parameters of a node as ROS 2's tools see them: its six services and /parameter_events. All but those
/// with a `change` are read-only.
class ParameterServer {
 public:
  using Value = rcl_interfaces::msg::ParameterValue;
  using Descriptor = rcl_interfaces::msg::ParameterDescriptor;

  /// `incompatible` is for subscribers of /parameter_events. Throws rcl::Error.
  ParameterServer(rcl::Node& node, const MessageClock& clock, rcl::OnIncompatible incompatible);

  /// The descriptor has the name and the type; a value without a type is not set. To be called again when the
  /// value has changed. `change` is called in the inbox's thread.
  void declare(Descriptor descriptor, const Value& value, std::function<void(const Value&)> change = {});

 private:
  struct Declared {
    Descriptor descriptor;
    Value value;
    std::function<void(const Value&)> change;
  };
  using Parameter = rcl_interfaces::msg::Parameter;
  using Result = rcl_interfaces::msg::SetParametersResult;

  /// Offers a service that calls answer(request, response) with the mutex locked.
  template <class S, class Answer>
  void offer(const char* name, Answer answer);
  /// An unknown parameter has none.
  Value value_of(const std::string& name) const;
  Result check(const Parameter& parameter) const;
  /// All of them or none.
  Result set(const std::vector<Parameter>& parameters);
  void publish_event(const std::string& name, const Value& value, bool is_new);

  rcl::Node& node_;
  const MessageClock& clock_;
  std::mutex mutex_;
  std::map<std::string, Declared> declared_;
  rcl::Publisher<rcl_interfaces::msg::ParameterEvent> events_;
  std::vector<std::shared_ptr<void>> services_;  // last: they use the others
};

}  // namespace coupler::host
