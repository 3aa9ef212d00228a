// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/ros1/ros_parameters.hpp"

#include <ros/param.h>
#include <ros/this_node.h>

#include <algorithm>

#include <fmt/format.h>

#include "coupler/map/loader/nearest.hpp"

namespace coupler::host {
namespace {

std::optional<std::string> as_text(XmlRpc::XmlRpcValue& value);

/// The elements, separated by commas.
std::optional<std::string> as_list(XmlRpc::XmlRpcValue& value) {
  std::string list;
  for (int i = 0; i < value.size(); ++i) {
    const auto text = as_text(value[i]);
    if (!text) return std::nullopt;
    list += (i > 0 ? "," : "") + *text;
  }
  return list;
}

std::optional<std::string> as_text(XmlRpc::XmlRpcValue& value) {
  switch (value.getType()) {
    case XmlRpc::XmlRpcValue::TypeBoolean: return static_cast<bool>(value) ? "true" : "false";
    case XmlRpc::XmlRpcValue::TypeInt: return fmt::to_string(static_cast<int>(value));
    case XmlRpc::XmlRpcValue::TypeDouble: return fmt::to_string(static_cast<double>(value));
    case XmlRpc::XmlRpcValue::TypeString: return static_cast<std::string>(value);
    case XmlRpc::XmlRpcValue::TypeArray: return as_list(value);
    default: return std::nullopt;
  }
}

/// Those of the libraries that the driver uses.
constexpr std::string_view of_others[] = {"diagnostic_period", "diagnostic_updater_fast"};

void add_unknown(XmlRpc::XmlRpcValue& tree, const std::string& place,
                 const std::vector<std::string_view>& devices, std::vector<std::string>& lines) {
  if (tree.getType() != XmlRpc::XmlRpcValue::TypeStruct) return;
  for (auto& [name, value] : tree) {
    if (std::find(std::begin(of_others), std::end(of_others), name) != std::end(of_others)) continue;
    if (std::find(devices.begin(), devices.end(), name) != devices.end())
      add_unknown(value, fmt::format("{}/{}", place, name), {}, lines);
    else if (!is_setting(name))
      lines.push_back(
          fmt::format("parameter {}/{} is not a setting and does nothing; {}", place, name,
                      loader::nearest_or(name, setting_names(), "coupler_driver --help shows them")));
  }
}

}  // namespace

std::vector<std::string> unknown_parameters(const std::vector<std::string_view>& devices) {
  std::vector<std::string> lines;
  XmlRpc::XmlRpcValue tree;
  if (ros::param::get(ros::this_node::getName(), tree))
    add_unknown(tree, ros::this_node::getName(), devices, lines);
  return lines;
}

tl::expected<Settings, std::string> read_parameters(const ros::NodeHandle& handle) {
  Settings settings;
  for (const SettingKey& key : setting_keys) {
    for (const std::string_view name : {key.alias, key.key}) {  // the key wins over its alias
      XmlRpc::XmlRpcValue value;
      if (name.empty() || !handle.getParam(std::string(name), value)) continue;
      const auto text = as_text(value);
      if (!text)
        return tl::make_unexpected(
            fmt::format("parameter {}: a value or a list is needed", handle.resolveName(std::string(name))));
      if (const auto done = set(settings, key.key, *text); !done)
        return tl::make_unexpected(fmt::format("parameter {}/{}", handle.getNamespace(), done.error()));
    }
  }
  return settings;
}

}  // namespace coupler::host
