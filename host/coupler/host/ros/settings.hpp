// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "coupler/host/core/identity_check.hpp"
#include "coupler/map/map.hpp"

namespace coupler::host {

/// What may be said about a device, or about all of them, outside its map. Precedence: map < ROS parameter <
/// argument.
struct Settings {
  std::optional<std::string> map;  ///< path, or tcp://HOST[:PORT][/UNIT]
  std::vector<std::string> maps;   ///< PATH or NAME=PATH, for several devices; empty: not given
  std::optional<std::string> name;
  std::optional<std::string> address;
  std::optional<std::uint16_t> port;
  std::optional<std::uint8_t> unit;
  std::optional<double> rate;                        ///< Hz, above 0
  std::optional<std::chrono::milliseconds> timeout;  ///< above 0; given in seconds
  std::optional<Verify> verify;
  std::optional<Poll> poll;
};

/// One setting by its name, as ROS parameter and as argument (`--key VALUE`).
struct SettingKey {
  enum class Kind { text, list, whole, real };

  std::string_view key;
  std::string_view alias;  ///< its name in ros-modbus-device-driver, or empty
  Kind kind;
  double min;  ///< of a number
  double max;
  std::string_view unit;  ///< behind a number, or empty
  std::string_view help;
};
extern const std::array<SettingKey, 10> setting_keys;
/// Of all of them, the other spellings included.
std::vector<std::string_view> setting_names();
bool is_setting(std::string_view name);
/// "there is no such setting; did you mean 'poll'?"
std::string no_such_setting(std::string_view name);

/// Sets what the text says. The error says what the value should have been.
tl::expected<void, std::string> set(Settings& settings, std::string_view key, const std::string& text);

/// What was set, as set() takes it; nullopt: nothing.
std::optional<std::string> text_of(const Settings& settings, std::string_view key);

/// `strong` where it says something, `weak` elsewhere. `map` and `maps` are one thing to say.
Settings overlay(Settings weak, const Settings& strong);

/// As if all that the map says had been set.
Settings with_map(Settings settings, const Map& map);

/// Overrides the map's fields. The map then refers to the settings' texts.
void apply(const Settings& settings, Map& map);

}  // namespace coupler::host
