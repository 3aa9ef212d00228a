// SPDX-License-Identifier: Apache-2.0
#include "host/ros2/shown_settings.hpp"

#include <rcl_interfaces/msg/parameter_type.hpp>

#include <fmt/format.h>

namespace coupler::driver {
namespace {

using Descriptor = ParameterServer::Descriptor;
using Kind = SettingKey::Kind;
using Type = rcl_interfaces::msg::ParameterType;
using Value = ParameterServer::Value;

std::uint8_t type_of(Kind kind) {
  switch (kind) {
    case Kind::list: return Type::PARAMETER_STRING_ARRAY;
    case Kind::whole: return Type::PARAMETER_INTEGER;
    case Kind::real: return Type::PARAMETER_DOUBLE;
    case Kind::text: break;
  }
  return Type::PARAMETER_STRING;
}

Descriptor describe(const SettingKey& key, const std::string& prefix) {
  Descriptor descriptor;
  descriptor.name = fmt::format("{}{}", prefix, key.key);
  descriptor.type = type_of(key.kind);
  descriptor.description = std::string(key.help);
  if (key.kind == Kind::whole) {
    descriptor.integer_range.resize(1);
    descriptor.integer_range[0].from_value = static_cast<std::int64_t>(key.min);
    descriptor.integer_range[0].to_value = static_cast<std::int64_t>(key.max);
    descriptor.integer_range[0].step = 1;
  }
  if (key.kind == Kind::real) {
    descriptor.floating_point_range.resize(1);
    descriptor.floating_point_range[0].from_value = key.min;
    descriptor.floating_point_range[0].to_value = key.max;
  }
  return descriptor;
}

Value of_kind(Kind kind) {
  Value value;
  value.type = type_of(kind);
  return value;
}

Value text(const std::optional<std::string>& setting) {
  if (!setting) return Value();
  Value value = of_kind(Kind::text);
  value.string_value = *setting;
  return value;
}

template <class T>
Value whole(const std::optional<T>& setting) {
  if (!setting) return Value();
  Value value = of_kind(Kind::whole);
  value.integer_value = *setting;
  return value;
}

Value real(const std::optional<double>& setting) {
  if (!setting) return Value();
  Value value = of_kind(Kind::real);
  value.double_value = *setting;
  return value;
}

Value list(const std::vector<std::string>& setting) {
  if (setting.empty()) return Value();
  Value value = of_kind(Kind::list);
  value.string_array_value = setting;
  return value;
}

std::optional<double> seconds(const std::optional<std::chrono::milliseconds>& time) {
  if (!time) return std::nullopt;
  return std::chrono::duration<double>(*time).count();
}

std::optional<std::string> word(const std::optional<Verify>& verify) {
  if (!verify) return std::nullopt;
  return *verify == Verify::require ? "require" : *verify == Verify::warn ? "warn" : "off";
}

std::optional<std::string> word(const std::optional<Poll>& poll) {
  if (!poll) return std::nullopt;
  return *poll == Poll::all ? "all" : "subscribed";
}

Value value_of(std::string_view key, const Settings& settings) {
  if (key == "map") return text(settings.map);
  if (key == "maps") return list(settings.maps);
  if (key == "name") return text(settings.name);
  if (key == "address") return text(settings.address);
  if (key == "port") return whole(settings.port);
  if (key == "unit") return whole(settings.unit);
  if (key == "rate") return real(settings.rate);
  if (key == "timeout") return real(seconds(settings.timeout));
  if (key == "verify") return text(word(settings.verify));
  return text(word(settings.poll));
}

/// As if all that the map says had been given.
Settings effective(const Configured& device) {
  Settings settings = device.settings;
  const Map& map = device.source.map;
  settings.name = std::string(map.name);
  settings.address = std::string(map.connection.address);
  settings.port = map.connection.port;
  settings.unit = map.connection.unit;
  settings.timeout = map.connection.timeout;
  settings.rate = map.polling.rate;
  settings.verify = settings.verify.value_or(Verify::require);
  settings.poll = map.poll;
  return settings;
}

}  // namespace

void show_given(ParameterServer& server, const Settings& settings) {
  for (const SettingKey& key : setting_keys) server.declare(describe(key, ""), value_of(key.key, settings));
}

void show_effective(ParameterServer& server, const Settings& settings, const Devices& devices) {
  if (devices.size() == 1) return show_given(server, effective(devices.front()));
  show_given(server, settings);
  for (const Configured& device : devices)
    for (const SettingKey& key : setting_keys)
      if (key.key != "map" && key.key != "maps")
        server.declare(describe(key, fmt::format("{}.", device.source.map.name)),
                       value_of(key.key, effective(device)));
}

}  // namespace coupler::driver
