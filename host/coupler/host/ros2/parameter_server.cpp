// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/ros2/parameter_server.hpp"

#include <rcl_interfaces/srv/describe_parameters.hpp>
#include <rcl_interfaces/srv/get_parameter_types.hpp>
#include <rcl_interfaces/srv/get_parameters.hpp>
#include <rcl_interfaces/srv/list_parameters.hpp>
#include <rcl_interfaces/srv/set_parameters.hpp>
#include <rcl_interfaces/srv/set_parameters_atomically.hpp>

#include <algorithm>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "coupler/host/ros2/rcl/service.hpp"

namespace coupler::host {
namespace {

namespace srv = rcl_interfaces::srv;

constexpr std::size_t events_depth = 1000;  ///< as of every node

/// Returns whether list_parameters() wants a name. `depth` counts the dots behind the prefix; 0: any number.
bool is_listed(const std::string& name, const std::vector<std::string>& prefixes, std::uint64_t depth) {
  const auto dots = [](const std::string& text) {
    return static_cast<std::uint64_t>(std::count(text.begin(), text.end(), '.'));
  };
  if (prefixes.empty()) return depth == 0 || dots(name) < depth;
  return std::any_of(prefixes.begin(), prefixes.end(), [&](const std::string& prefix) {
    if (name == prefix) return true;
    const bool is_below = name.compare(0, prefix.size() + 1, prefix + ".") == 0;
    return is_below && (depth == 0 || dots(name.substr(prefix.size() + 1)) < depth);
  });
}

}  // namespace

ParameterServer::ParameterServer(rcl::Node& node, const MessageClock& clock, rcl::OnIncompatible incompatible)
    : node_(node),
      clock_(clock),
      events_(node, "/parameter_events", rcl::reliable(events_depth), {{}, std::move(incompatible)}) {
  offer<srv::DescribeParameters>("describe_parameters", [this](const auto& request, auto& response) {
    for (const std::string& name : request.names) {
      const auto found = declared_.find(name);
      if (found == declared_.end()) return response.descriptors.clear();  // as rclcpp where one is unknown
      response.descriptors.push_back(found->second.descriptor);
    }
  });
  offer<srv::GetParameterTypes>("get_parameter_types", [this](const auto& request, auto& response) {
    for (const std::string& name : request.names) response.types.push_back(value_of(name).type);
  });
  offer<srv::GetParameters>("get_parameters", [this](const auto& request, auto& response) {
    for (const std::string& name : request.names) response.values.push_back(value_of(name));
  });
  offer<srv::ListParameters>("list_parameters", [this](const auto& request, auto& response) {
    std::set<std::string> prefixes;
    for (const auto& [name, declared] : declared_) {
      if (!is_listed(name, request.prefixes, request.depth)) continue;
      response.result.names.push_back(name);
      if (const std::size_t dot = name.rfind('.'); dot != std::string::npos)
        prefixes.insert(name.substr(0, dot));
    }
    response.result.prefixes.assign(prefixes.begin(), prefixes.end());
  });
  offer<srv::SetParameters>("set_parameters", [this](const auto& request, auto& response) {
    for (const Parameter& parameter : request.parameters) response.results.push_back(set({parameter}));
  });
  offer<srv::SetParametersAtomically>(
      "set_parameters_atomically",
      [this](const auto& request, auto& response) { response.result = set(request.parameters); });
}

template <class S, class Answer>
void ParameterServer::offer(const char* name, Answer answer) {
  services_.push_back(
      rcl::offer<S>(node_, fmt::format("~/{}", name), [this, answer](const auto& request, auto& response) {
        const std::lock_guard lock(mutex_);
        answer(request, response);
      }));
}

void ParameterServer::declare(Descriptor descriptor, const Value& value,
                              std::function<void(const Value&)> change) {
  const std::lock_guard lock(mutex_);
  descriptor.read_only = !change;
  const std::string name = descriptor.name;
  const auto before = declared_.find(name);
  const bool is_new = before == declared_.end();
  const bool has_changed = is_new || before->second.value != value;
  declared_[name] = {std::move(descriptor), value, std::move(change)};
  if (has_changed) publish_event(name, value, is_new);
}

void ParameterServer::publish_event(const std::string& name, const Value& value, bool is_new) {
  rcl_interfaces::msg::ParameterEvent event;
  event.stamp = clock_.now();
  event.node = node_.full_name();
  Parameter parameter;
  parameter.name = name;
  parameter.value = value;
  (is_new ? event.new_parameters : event.changed_parameters).push_back(std::move(parameter));
  events_.publish(event);
}

ParameterServer::Value ParameterServer::value_of(const std::string& name) const {
  const auto found = declared_.find(name);
  return found == declared_.end() ? Value() : found->second.value;
}

ParameterServer::Result ParameterServer::check(const Parameter& parameter) const {
  Result result;
  const auto found = declared_.find(parameter.name);
  if (found == declared_.end()) {
    result.reason = fmt::format("there is no parameter '{}'", parameter.name);
  } else if (found->second.descriptor.read_only) {
    result.reason = fmt::format(
        "parameter '{}' is read-only: give it when the driver is started, as in --ros-args "
        "-p {}:=VALUE",
        parameter.name, parameter.name);
  } else if (found->second.descriptor.type != parameter.value.type) {
    result.reason = fmt::format(
        "parameter '{}' has another type than this value; describe_parameters shows it", parameter.name);
  }
  result.successful = result.reason.empty();
  return result;
}

ParameterServer::Result ParameterServer::set(const std::vector<Parameter>& parameters) {
  Result result;
  result.successful = true;
  for (const Parameter& parameter : parameters) {
    result = check(parameter);
    if (!result.successful) return result;
  }
  for (const Parameter& parameter : parameters) {
    Declared& declared = declared_.at(parameter.name);
    declared.value = parameter.value;
    declared.change(parameter.value);
    publish_event(parameter.name, parameter.value, false);
  }
  return result;
}

}  // namespace coupler::host
