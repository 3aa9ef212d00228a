// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "coupler/host/core/identity_check.hpp"
#include "coupler/map/map.hpp"

namespace coupler::host {

/// The settings of a device, or of all devices, outside the map. Precedence: map < ROS parameter < argument.
struct Settings {
  std::optional<std::string> map;  ///< path, or the address of a node (coupler/map/node_address.hpp)
  std::vector<std::string> maps;   ///< PATH or NAME=PATH, for several devices; empty: not given
  std::optional<std::string> name;
  std::optional<std::string> address;
  std::optional<std::uint16_t> port;
  std::optional<std::uint8_t> unit;
  std::optional<Framing> framing;
  std::optional<std::string> serial;  ///< the port's device file; never beside an address
  std::optional<std::uint32_t> baud;
  std::optional<Serial::Parity> parity;
  std::optional<std::uint16_t> stop_bits;
  std::optional<bool> rs485;
  std::optional<std::string> certificate;  ///< this machine's; it and the next two are absolute paths
  std::optional<std::string> key;
  std::optional<std::string> ca;
  std::optional<std::string> tls_name;
  std::optional<std::string> pin;
  std::optional<double> rate;                        ///< Hz, above 0
  std::optional<std::chrono::milliseconds> timeout;  ///< above 0; given in seconds
  std::optional<Verify> verify;
  std::optional<Poll> poll;
  std::optional<std::vector<std::string>> topics;  ///< patterns of the points that have topics
  std::optional<std::string> record;               ///< absolute path of a recording
  std::optional<std::uint16_t> panel;              ///< port of a live page; above 0
};

/// Everything about one setting, which is both a ROS parameter and an argument (`--key VALUE`) of that name.
struct SettingKey {
  enum class Kind { text, list, integer, real };

  std::string_view key;
  std::string_view alias;  ///< its name in ros-modbus-device-driver, or empty
  Kind kind;
  double min;  ///< of a number
  double max;
  std::string_view unit;  ///< follows a number; or empty
  std::string_view help;

  /// Sets it from text. The error says what the value should have been.
  std::function<tl::expected<void, std::string>(Settings& settings, const std::string& text)> set{};
  /// Returns the text of the setting: see text_of().
  std::function<std::optional<std::string>(const Settings& settings)> text{};
  /// Copies the setting from `strong` to `weak` if it is set there: see overlay().
  std::function<void(Settings& weak, const Settings& strong)> prefer{};
  /// Copies the setting from the map. It is empty if a map has no such key.
  std::function<void(Settings& settings, Map& map)> from_map{};
  /// Copies the setting to the map if it is set. It is empty if a map has no such key, or if apply() does it.
  std::function<void(const Settings& settings, Map& map)> to_map{};
};
const std::vector<SettingKey>& setting_keys();
/// Returns the names of all settings, including the aliases.
std::vector<std::string_view> setting_names();
bool is_setting(std::string_view name);
/// Returns "there is no such setting; did you mean 'poll'?".
std::string no_such_setting(std::string_view name);

/// Returns "parameter ~/pol is not a setting and does nothing; did you mean 'poll'?". `name` is the name of
/// the parameter without its prefix.
std::string unknown_parameter(std::string_view parameter, std::string_view name);

/// Sets one setting from text. The error says what the value should have been.
tl::expected<void, std::string> set(Settings& settings, std::string_view key, const std::string& text);

/// Returns the settings among the parameters that begin with `prefix`. `text_of` returns the text of the
/// parameter of that name, nullopt if it is not given, or what is wrong with it. An empty text counts as not
/// given, because launch files pass those. The error names the parameter, including its prefix.
using ParameterText = tl::expected<std::optional<std::string>, std::string>;
tl::expected<Settings, std::string> settings_among(
    std::string_view prefix,
    const std::function<ParameterText(const SettingKey& key, const std::string& name)>& text_of);

/// Returns the items of the text of a list: "a.yaml,b.yaml", or [a.yaml, "b.yaml"] as in YAML.
std::vector<std::string> items_of(std::string_view list);

/// Returns what was set, in the form that set() takes; nullopt if it was not set.
std::optional<std::string> text_of(const Settings& settings, std::string_view key);

/// Returns what is set in `strong`, and the rest from `weak`. `map` and `maps` count as one setting, and so
/// do an address and a serial port, each with what belongs to it.
Settings overlay(Settings weak, const Settings& strong);

/// Returns the settings with the values of the map, as if all of them had been set.
Settings with_map(Settings settings, const Map& map);

/// Overrides the map's fields with the settings that are set. The map then views their texts.
void apply(const Settings& settings, Map& map);

}  // namespace coupler::host
