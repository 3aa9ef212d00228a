// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/ros2/parameter_server.hpp"

#include <rcl_interfaces/msg/parameter_type.hpp>

#include <algorithm>
#include <set>
#include <utility>

#include <fmt/format.h>

namespace coupler::host {
namespace {

constexpr std::size_t events_depth = 1000;  ///< as of every node

/// Whether list_parameters() wants a name: `depth` counts the dots behind the prefix; 0: any number.
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
  offer<Describe>("describe_parameters", &ParameterServer::describe);
  offer<Types>("get_parameter_types", &ParameterServer::types);
  offer<Get>("get_parameters", &ParameterServer::get);
  offer<List>("list_parameters", &ParameterServer::list);
  offer<SetEach>("set_parameters", &ParameterServer::set_each);
  offer<SetAll>("set_parameters_atomically", &ParameterServer::set_all);
}

template <class S>
void ParameterServer::offer(const char* name, Answer<S> answer) {
  services_.push_back(std::make_shared<rcl::PromptService<S>>(
      node_, fmt::format("~/{}", name), [this, answer](const auto& request, auto& response) {
        const std::lock_guard lock(mutex_);
        (this->*answer)(request, response);
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

void ParameterServer::describe(const Describe::Request& request, Describe::Response& response) {
  for (const std::string& name : request.names) {
    const auto found = declared_.find(name);
    if (found == declared_.end()) {
      response.descriptors.clear();  // as rclcpp answers where one is unknown
      return;
    }
    response.descriptors.push_back(found->second.descriptor);
  }
}

void ParameterServer::types(const Types::Request& request, Types::Response& response) {
  for (const std::string& name : request.names) {
    const auto found = declared_.find(name);
    response.types.push_back(found == declared_.end() ? std::uint8_t{} : found->second.value.type);
  }
}

void ParameterServer::get(const Get::Request& request, Get::Response& response) {
  for (const std::string& name : request.names) {
    const auto found = declared_.find(name);
    response.values.push_back(found == declared_.end() ? Value() : found->second.value);
  }
}

void ParameterServer::list(const List::Request& request, List::Response& response) {
  std::set<std::string> prefixes;
  for (const auto& [name, declared] : declared_) {
    if (!is_listed(name, request.prefixes, request.depth)) continue;
    response.result.names.push_back(name);
    if (const std::size_t dot = name.rfind('.'); dot != std::string::npos)
      prefixes.insert(name.substr(0, dot));
  }
  response.result.prefixes.assign(prefixes.begin(), prefixes.end());
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

void ParameterServer::set(const Parameter& parameter) {
  Declared& declared = declared_.at(parameter.name);
  declared.value = parameter.value;
  declared.change(parameter.value);
  publish_event(parameter.name, parameter.value, false);
}

void ParameterServer::set_each(const SetEach::Request& request, SetEach::Response& response) {
  for (const Parameter& parameter : request.parameters) {
    response.results.push_back(check(parameter));
    if (response.results.back().successful) set(parameter);
  }
}

void ParameterServer::set_all(const SetAll::Request& request, SetAll::Response& response) {
  response.result.successful = true;
  for (const Parameter& parameter : request.parameters) {
    response.result = check(parameter);
    if (!response.result.successful) return;
  }
  for (const Parameter& parameter : request.parameters) set(parameter);
}

}  // namespace coupler::host
