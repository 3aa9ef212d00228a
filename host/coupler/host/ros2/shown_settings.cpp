// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/ros2/shown_settings.hpp"

#include <rcl_interfaces/msg/parameter_type.hpp>

#include <cstdlib>

#include <fmt/format.h>

namespace coupler::host {
namespace {

using Kind = SettingKey::Kind;
using Type = rcl_interfaces::msg::ParameterType;

std::uint8_t type_of(Kind kind) {
  switch (kind) {
    case Kind::list: return Type::PARAMETER_STRING_ARRAY;
    case Kind::whole: return Type::PARAMETER_INTEGER;
    case Kind::real: return Type::PARAMETER_DOUBLE;
    case Kind::text: break;
  }
  return Type::PARAMETER_STRING;
}

ParameterServer::Descriptor describe(const SettingKey& key, const std::string& prefix) {
  ParameterServer::Descriptor descriptor;
  descriptor.name = fmt::format("{}{}", prefix, key.key);
  descriptor.type = type_of(key.kind);
  descriptor.description = std::string(key.help);
  if (key.kind == Kind::whole) {
    auto& range = descriptor.integer_range.emplace_back();
    range.from_value = static_cast<std::int64_t>(key.min);
    range.to_value = static_cast<std::int64_t>(key.max);
    range.step = 1;
  } else if (key.kind == Kind::real) {
    auto& range = descriptor.floating_point_range.emplace_back();
    range.from_value = key.min;
    range.to_value = key.max;
  }
  return descriptor;
}

ParameterServer::Value value_of(const SettingKey& key, const Settings& settings) {
  ParameterServer::Value value;
  const auto text = text_of(settings, key.key);
  if (!text) return value;
  value.type = type_of(key.kind);
  switch (key.kind) {
    case Kind::list: value.string_array_value = settings.maps; break;
    case Kind::whole: value.integer_value = std::strtoll(text->c_str(), nullptr, 10); break;
    case Kind::real: value.double_value = std::strtod(text->c_str(), nullptr); break;
    case Kind::text: value.string_value = *text; break;
  }
  return value;
}

}  // namespace

void show_settings(ParameterServer& server, const Settings& settings) {
  for (const SettingKey& key : setting_keys) server.declare(describe(key, ""), value_of(key, settings));
}

void show_devices(ParameterServer& server, const Devices& devices) {
  if (devices.size() == 1)
    return show_settings(server, with_map(devices.front().settings, devices.front().source.map));
  for (const auto& [settings, source] : devices)
    for (const SettingKey& key : setting_keys)
      if (key.key != "map" && key.key != "maps")
        server.declare(describe(key, fmt::format("{}.", source.map.name)),
                       value_of(key, with_map(settings, source.map)));
}

}  // namespace coupler::host
