// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <rcl_interfaces/msg/parameter.hpp>
#include <rcl_interfaces/msg/parameter_descriptor.hpp>
#include <rcl_interfaces/msg/parameter_event.hpp>
#include <rcl_interfaces/msg/set_parameters_result.hpp>
#include <rcl_interfaces/srv/describe_parameters.hpp>
#include <rcl_interfaces/srv/get_parameter_types.hpp>
#include <rcl_interfaces/srv/get_parameters.hpp>
#include <rcl_interfaces/srv/list_parameters.hpp>
#include <rcl_interfaces/srv/set_parameters.hpp>
#include <rcl_interfaces/srv/set_parameters_atomically.hpp>

#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "coupler/host/ros2/message_clock.hpp"
#include "coupler/host/ros2/rcl/service.hpp"
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

  template <class S>
  using Answer = void (ParameterServer::*)(const typename S::Request&, typename S::Response&);
  template <class S>
  void offer(const char* name, Answer<S> answer);
  using Describe = rcl_interfaces::srv::DescribeParameters;
  using Types = rcl_interfaces::srv::GetParameterTypes;
  using Get = rcl_interfaces::srv::GetParameters;
  using List = rcl_interfaces::srv::ListParameters;
  using SetEach = rcl_interfaces::srv::SetParameters;
  using SetAll = rcl_interfaces::srv::SetParametersAtomically;
  void describe(const Describe::Request& request, Describe::Response& response);
  void types(const Types::Request& request, Types::Response& response);
  void get(const Get::Request& request, Get::Response& response);
  void list(const List::Request& request, List::Response& response);
  void set_each(const SetEach::Request& request, SetEach::Response& response);
  void set_all(const SetAll::Request& request, SetAll::Response& response);
  Result check(const Parameter& parameter) const;
  void set(const Parameter& parameter);
  void publish_event(const std::string& name, const Value& value, bool is_new);

  rcl::Node& node_;
  const MessageClock& clock_;
  std::mutex mutex_;
  std::map<std::string, Declared> declared_;
  rcl::Publisher<rcl_interfaces::msg::ParameterEvent> events_;
  std::vector<std::shared_ptr<void>> services_;  // last: they use the others
};

}  // namespace coupler::host
