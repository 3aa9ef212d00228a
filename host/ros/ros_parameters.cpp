// SPDX-License-Identifier: Apache-2.0
#include "host/ros/ros_parameters.hpp"

#include <fmt/format.h>

namespace coupler::driver {
namespace {

std::optional<std::string> as_text(XmlRpc::XmlRpcValue& value) {
  switch (value.getType()) {
    case XmlRpc::XmlRpcValue::TypeBoolean: return static_cast<bool>(value) ? "true" : "false";
    case XmlRpc::XmlRpcValue::TypeInt: return fmt::to_string(static_cast<int>(value));
    case XmlRpc::XmlRpcValue::TypeDouble: return fmt::to_string(static_cast<double>(value));
    case XmlRpc::XmlRpcValue::TypeString: return static_cast<std::string>(value);
    default: return std::nullopt;
  }
}

}  // namespace

tl::expected<Settings, std::string> read_parameters(const ros::NodeHandle& private_handle) {
  Settings settings;
  for (const SettingKey& key : setting_keys) {
    for (const std::string_view name : {key.alias, key.key}) {  // the key wins over its alias
      XmlRpc::XmlRpcValue value;
      if (name.empty() || !private_handle.getParam(std::string(name), value)) continue;
      const auto text = as_text(value);
      if (!text) return tl::make_unexpected(fmt::format("parameter ~{}: a single value is needed", name));
      if (const auto done = set(settings, key.key, *text); !done)
        return tl::make_unexpected("parameter ~" + done.error());
    }
  }
  return settings;
}

}  // namespace coupler::driver
