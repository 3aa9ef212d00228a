// SPDX-License-Identifier: Apache-2.0
// Settings as text: where parameters and arguments come from.
#include "coupler/host/ros/settings.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <filesystem>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "coupler/base/enumeration.hpp"
#include "coupler/map/loader/names.hpp"
#include "coupler/map/network.hpp"
#include "coupler/map/node_address.hpp"

namespace coupler::host {
namespace {

using Outcome = tl::expected<void, std::string>;

tl::unexpected<std::string> wrong(std::string_view key, const std::string& text, std::string_view expected) {
  return tl::make_unexpected(fmt::format("{}: '{}' is not {}", key, text, expected));
}

std::optional<double> number(const std::string& text) {
  char* end = nullptr;
  errno = 0;
  const double value = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0' || errno != 0 || !std::isfinite(value)) return std::nullopt;
  return value;
}

/// A number in the key's range.
template <class T>
Outcome set_number(std::optional<T>& field, const SettingKey& key, const std::string& text) {
  const auto value = number(text);
  const bool is_integer = key.kind == SettingKey::Kind::integer;
  if (!value || *value < key.min || *value > key.max || (is_integer && *value != std::floor(*value)))
    return wrong(key.key, text,
                 fmt::format("a {} from {} to {}{}", is_integer ? "whole number" : "number", key.min, key.max,
                             key.unit));
  field = static_cast<T>(*value);
  return {};
}

Outcome set_timeout(Settings& settings, const SettingKey& key, const std::string& text) {
  std::optional<double> seconds;
  if (auto done = set_number(seconds, key, text); !done) return done;
  settings.timeout = std::chrono::milliseconds(std::lround(*seconds * 1000));
  return {};
}

Outcome set_verify(Settings& settings, const std::string& text) {
  // ROS reads "off" as a boolean where a parameter comes from YAML.
  settings.verify = parse_word<Verify>(text == "false" ? "off" : text);
  return settings.verify ? Outcome{} : wrong("verify", text, "require, warn or off");
}

Outcome set_poll(Settings& settings, const std::string& text) {
  settings.poll = parse_word<Poll>(text);
  return settings.poll ? Outcome{} : wrong("poll", text, "all or subscribed");
}

Outcome set_framing(Settings& settings, const std::string& text) {
  settings.framing = parse_word<Framing>(text);
  return settings.framing ? Outcome{} : wrong("framing", text, "tcp or rtu");
}

Outcome set_serial(Settings& settings, const std::string& text) {
  if (text.empty() || names_a_node(text))
    return wrong("serial", text,
                 "a device file, as /dev/ttyUSB0; its unit and baud rate are settings of their own");
  settings.serial = text;
  return {};
}

Outcome set_baud(Settings& settings, const SettingKey& key, const std::string& text) {
  if (auto done = set_number(settings.baud, key, text); !done) return done;
  if (is_serial_rate(*settings.baud)) return {};
  return wrong("baud", text, fmt::format("one of {}", fmt::join(serial_rates, ", ")));
}

Outcome set_parity(Settings& settings, const std::string& text) {
  settings.parity = parse_word<Serial::Parity>(text);
  return settings.parity ? Outcome{} : wrong("parity", text, "even, odd or none");
}

Outcome set_rs485(Settings& settings, const std::string& text) {
  settings.rs485 = text == "true";
  return *settings.rs485 || text == "false" ? Outcome{} : wrong("rs485", text, "true or false");
}

Outcome set_map(Settings& settings, const std::string& text) {
  if (text.empty()) return wrong("map", text, "a path or tcp://HOST; leave the setting out if there is none");
  settings.map = text;
  return {};
}

Outcome set_address(Settings& settings, const std::string& text) {
  const auto host = parse_host(text);
  if (!host)
    return tl::make_unexpected(
        fmt::format("address: '{}' {}; {}", text, host.error().what, host.error().remedy));
  settings.address = std::string(*host);
  return {};
}

Outcome set_name(Settings& settings, const std::string& text) {
  if (!loader::is_relative_ros_name(text))
    return wrong("name", text, "a name in ROS: a letter, then letters, digits, '_' and '/'");
  settings.name = text;
  return {};
}

std::string_view without(std::string_view text, std::string_view front, std::string_view back) {
  const std::size_t from = text.find_first_not_of(front);
  if (from == std::string_view::npos) return {};
  return text.substr(from, text.find_last_not_of(back) - from + 1);
}

/// "a.yaml,b.yaml", also as YAML has it: [a.yaml, "b.yaml"].
Outcome set_maps(Settings& settings, const std::string& text) {
  std::string_view rest = without(text, " [", " ]");
  settings.maps.clear();
  while (!rest.empty()) {
    const std::size_t comma = std::min(rest.find(','), rest.size());
    const std::string_view item = without(rest.substr(0, comma), " '\"", " '\"");
    if (!item.empty()) settings.maps.emplace_back(item);
    rest.remove_prefix(std::min(comma + 1, rest.size()));
  }
  if (settings.maps.empty()) return wrong("maps", text, "a list of paths, as in [a.yaml,b.yaml]");
  return {};
}

/// It begins in the working directory, not beside the map.
Outcome set_file(std::optional<std::string>& field, std::string_view key, const std::string& text) {
  if (text.empty()) return wrong(key, text, "a path; leave the setting out if there is none");
  field = std::filesystem::absolute(text).string();
  return {};
}

Outcome set_tls_name(Settings& settings, const std::string& text) {
  if (const auto host = parse_host(text); !host)
    return tl::make_unexpected(
        fmt::format("tls_name: '{}' {}; {}", text, host.error().what, host.error().remedy));
  settings.tls_name = text;
  return {};
}

Outcome set_pin(Settings& settings, const std::string& text) {
  if (!is_pin(text))
    return wrong("pin", text, "'sha256:' and 64 hexadecimal digits, as `coupler pin` prints them");
  settings.pin = text;
  return {};
}

/// Those that are a text as it stands.
constexpr std::pair<std::string_view, std::optional<std::string> Settings::*> texts[] = {
    {"map", &Settings::map},
    {"name", &Settings::name},
    {"address", &Settings::address},
    {"serial", &Settings::serial},
    {"certificate", &Settings::certificate},
    {"key", &Settings::key},
    {"ca", &Settings::ca},
    {"tls_name", &Settings::tls_name},
    {"pin", &Settings::pin},
    {"record", &Settings::record}};

}  // namespace

Outcome set(Settings& settings, std::string_view name, const std::string& text) {
  const auto* const found = std::find_if(setting_keys.begin(), setting_keys.end(),
                                         [&](const SettingKey& one) { return one.key == name; });
  if (found == setting_keys.end())
    return tl::make_unexpected(fmt::format("{}: {}", name, no_such_setting(name)));
  const SettingKey& setting = *found;
  const std::string_view key = setting.key;
  if (key == "map") return set_map(settings, text);
  if (key == "maps") return set_maps(settings, text);
  if (key == "name") return set_name(settings, text);
  if (key == "address") return set_address(settings, text);
  if (key == "port") return set_number(settings.port, setting, text);
  if (key == "unit") return set_number(settings.unit, setting, text);
  if (key == "framing") return set_framing(settings, text);
  if (key == "serial") return set_serial(settings, text);
  if (key == "baud") return set_baud(settings, setting, text);
  if (key == "parity") return set_parity(settings, text);
  if (key == "stop_bits") return set_number(settings.stop_bits, setting, text);
  if (key == "rs485") return set_rs485(settings, text);
  if (key == "certificate") return set_file(settings.certificate, key, text);
  if (key == "key") return set_file(settings.key, key, text);
  if (key == "ca") return set_file(settings.ca, key, text);
  if (key == "tls_name") return set_tls_name(settings, text);
  if (key == "pin") return set_pin(settings, text);
  if (key == "rate") return set_number(settings.rate, setting, text);
  if (key == "timeout") return set_timeout(settings, setting, text);
  if (key == "verify") return set_verify(settings, text);
  if (key == "record") return set_file(settings.record, key, text);
  if (key == "panel") return set_number(settings.panel, setting, text);
  return set_poll(settings, text);
}

std::optional<std::string> text_of(const Settings& settings, std::string_view key) {
  const auto number = [](const auto& field) {
    return field ? std::optional(fmt::to_string(*field)) : std::nullopt;
  };
  const auto word = [](const auto& field) {
    return field ? std::optional(std::string(coupler::to_string(*field))) : std::nullopt;
  };
  for (const auto& [name, text] : texts)
    if (key == name) return settings.*text;
  if (key == "maps" && !settings.maps.empty()) return fmt::format("{}", fmt::join(settings.maps, ","));
  if (key == "port") return number(settings.port);
  if (key == "unit") return number(settings.unit);
  if (key == "framing") return word(settings.framing);
  if (key == "baud") return number(settings.baud);
  if (key == "parity") return word(settings.parity);
  if (key == "stop_bits") return number(settings.stop_bits);
  if (key == "rs485" && settings.rs485) return *settings.rs485 ? "true" : "false";
  if (key == "rate") return number(settings.rate);
  if (key == "timeout" && settings.timeout)
    return fmt::to_string(std::chrono::duration<double>(*settings.timeout).count());
  if (key == "verify") return word(settings.verify);
  if (key == "poll") return word(settings.poll);
  if (key == "panel") return number(settings.panel);
  return std::nullopt;
}

tl::expected<Settings, std::string> settings_among(
    std::string_view prefix,
    const std::function<ParameterText(const SettingKey& key, const std::string& name)>& text_of) {
  Settings settings;
  for (const SettingKey& key : setting_keys) {
    for (const std::string_view name : {key.alias, key.key}) {  // the key wins over its alias
      if (name.empty()) continue;
      const auto text = text_of(key, std::string(name));
      if (!text) return tl::make_unexpected(fmt::format("parameter {}{}: {}", prefix, name, text.error()));
      if (!*text) continue;
      if (const auto done = set(settings, key.key, **text); !done)
        return tl::make_unexpected(fmt::format("parameter {}{}", prefix, done.error()));
    }
  }
  return settings;
}

}  // namespace coupler::host
