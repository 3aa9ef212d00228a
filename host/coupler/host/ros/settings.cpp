// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/ros/settings.hpp"

#include <algorithm>
#include <string_view>

#include <fmt/format.h>

#include "coupler/map/nearest.hpp"
#include "coupler/map/tls_texts.hpp"

namespace coupler::host {
namespace {

const SettingKey* find(std::string_view name) {
  for (const SettingKey& key : setting_keys())
    if (key.key == name) return &key;
  return nullptr;
}

std::string nearest_setting(std::string_view name) {
  return nearest_or(name, setting_names(), or_update("see coupler_driver --help"));
}

void apply(const Settings& settings, Tls& tls) {
  const auto text = [](const std::optional<std::string>& setting) {
    return setting ? std::string_view(*setting) : std::string_view();
  };
  overlay(tls, {text(settings.certificate),
                text(settings.key),
                text(settings.ca),
                text(settings.tls_name),
                text(settings.pin),
                {}});
}

}  // namespace

std::vector<std::string_view> setting_names() {
  std::vector<std::string_view> names;
  for (const SettingKey& key : setting_keys()) {
    names.push_back(key.key);
    if (!key.alias.empty()) names.push_back(key.alias);
  }
  return names;
}

bool is_setting(std::string_view name) {
  const auto names = setting_names();
  return std::find(names.begin(), names.end(), name) != names.end();
}

std::string no_such_setting(std::string_view name) {
  return "there is no such setting; " + nearest_setting(name);
}

std::string unknown_parameter(std::string_view parameter, std::string_view name) {
  return fmt::format("parameter {} is not a setting and does nothing; {}", parameter, nearest_setting(name));
}

tl::expected<void, std::string> set(Settings& settings, std::string_view name, const std::string& text) {
  const SettingKey* key = find(name);
  if (key != nullptr) return key->set(settings, text);
  return tl::make_unexpected(fmt::format("{}: {}", name, no_such_setting(name)));
}

std::optional<std::string> text_of(const Settings& settings, std::string_view name) {
  const SettingKey* key = find(name);
  return key == nullptr ? std::nullopt : key->text(settings);
}

tl::expected<Settings, std::string> settings_among(
    std::string_view prefix,
    const std::function<ParameterText(const SettingKey& key, const std::string& name)>& text_of) {
  Settings settings;
  for (const SettingKey& key : setting_keys()) {
    for (const std::string_view name : {key.alias, key.key}) {  // the key wins over its alias
      if (name.empty()) continue;
      const auto text = text_of(key, std::string(name));
      if (!text) return tl::make_unexpected(fmt::format("parameter {}{}: {}", prefix, name, text.error()));
      if (!*text || (*text)->empty()) continue;
      if (const auto done = key.set(settings, **text); !done)
        return tl::make_unexpected(fmt::format("parameter {}{}", prefix, done.error()));
    }
  }
  return settings;
}

Settings overlay(Settings weak, const Settings& strong) {
  if (strong.map || !strong.maps.empty()) {
    weak.map = strong.map;
    weak.maps = strong.maps;
  }
  if (strong.serial) {
    weak.address.reset();
    weak.port.reset();
    weak.framing.reset();
  }
  if (strong.address) {
    weak.serial.reset();
    weak.baud.reset();
    weak.parity.reset();
    weak.stop_bits.reset();
    weak.rs485.reset();
  }
  for (const SettingKey& key : setting_keys()) key.prefer(weak, strong);
  return weak;
}

Settings with_map(Settings settings, const Map& map) {
  Map copy = map;
  for (const SettingKey& key : setting_keys())
    if (key.from_map) key.from_map(settings, copy);
  return settings;
}

void apply(const Settings& settings, Map& map) {
  Connection& connection = map.connection;
  const bool was_rtu = connection.is_rtu();
  const bool had_tls = connection.tls.present();
  if (settings.address) {
    connection.framing = Framing::tcp;
    connection.serial.device = {};
  }
  for (const SettingKey& key : setting_keys())
    if (key.to_map) key.to_map(settings, map);
  if (settings.serial) connection.address = {};
  apply(settings, connection.tls);
  if (settings.serial) connection.tls = {};
  if (!had_tls && connection.tls.present() && !settings.port && connection.port == modbus::default_port)
    connection.port = default_tls_port;
  if (!settings.timeout) connection.changed_from(was_rtu);
}

}  // namespace coupler::host
