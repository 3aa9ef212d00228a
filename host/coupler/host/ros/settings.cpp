// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/ros/settings.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdlib>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "coupler/base/enumeration.hpp"
#include "coupler/map/loader/names.hpp"
#include "coupler/map/loader/nearest.hpp"
#include "coupler/map/network.hpp"
#include "coupler/map/node_address.hpp"

namespace coupler::host {
namespace {

using Outcome = tl::expected<void, std::string>;
using Kind = SettingKey::Kind;

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

std::string nearest_setting(std::string_view name) {
  return loader::nearest_or(name, setting_names(), "coupler_driver --help shows them");
}

template <class T>
void prefer(std::optional<T>& field, const std::optional<T>& strong) {
  if (strong) field = strong;
}

}  // namespace

const std::array<SettingKey, 16> setting_keys{{
    {"map", "mapping", Kind::text, 0, 0, "",
     "the device's map: a YAML or JSON file, or the address of a node, as tcp://HOST[:PORT][/UNIT]"},
    {"maps", "", Kind::list, 0, 0, "",
     "several devices in one process: their maps, as in --maps a.yaml,b.yaml; with names of their own, as in "
     "--maps left=io.yaml,right=io.yaml"},
    {"name", "", Kind::text, 0, 0, "", "namespace of the topics, instead of the map's"},
    {"address", "", Kind::text, 0, 0, "",
     "host name or IP address; alone, without a map: a node that serves its own"},
    {"port", "", Kind::integer, 1, 65535, "", "TCP port; 502 if the map has none"},
    {"unit", "", Kind::integer, 0, 255, "", "unit id"},
    {"framing", "", Kind::text, 0, 0, "", "tcp, or rtu for RTU over TCP"},
    {"serial", "", Kind::text, 0, 0, "", "serial port, as /dev/ttyUSB0, instead of an address"},
    {"baud", "", Kind::integer, 110, 4000000, "", "bits a second on the serial port"},
    {"parity", "", Kind::text, 0, 0, "", "even, odd or none"},
    {"stop_bits", "", Kind::integer, 1, 2, "", "stop bits on the serial port"},
    {"rs485", "", Kind::text, 0, 0, "", "true: the port's driver switches the direction of RS-485"},
    {"rate", "", Kind::real, 0.001, 10000, " Hz", "polling rate in Hz"},
    {"timeout", "", Kind::real, 0.001, 3600, " s", "longest wait for a reply, in seconds"},
    {"verify", "", Kind::text, 0, 0, "",
     "if the node's map differs: require (do not talk to it), warn (go on) or off (do not ask); instead of "
     "the "
     "map's"},
    {"poll", "", Kind::text, 0, 0, "",
     "which points are read: all (default), or subscribed: those that have subscribers; instead of the "
     "map's"},
}};

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
  if (key == "rate") return set_number(settings.rate, setting, text);
  if (key == "timeout") return set_timeout(settings, setting, text);
  if (key == "verify") return set_verify(settings, text);
  return set_poll(settings, text);
}

std::optional<std::string> text_of(const Settings& settings, std::string_view key) {
  const auto number = [](const auto& field) {
    return field ? std::optional(fmt::to_string(*field)) : std::nullopt;
  };
  const auto word = [](const auto& field) {
    return field ? std::optional(std::string(coupler::to_string(*field))) : std::nullopt;
  };
  if (key == "map") return settings.map;
  if (key == "maps" && !settings.maps.empty()) return fmt::format("{}", fmt::join(settings.maps, ","));
  if (key == "name") return settings.name;
  if (key == "address") return settings.address;
  if (key == "port") return number(settings.port);
  if (key == "unit") return number(settings.unit);
  if (key == "framing") return word(settings.framing);
  if (key == "serial") return settings.serial;
  if (key == "baud") return number(settings.baud);
  if (key == "parity") return word(settings.parity);
  if (key == "stop_bits") return number(settings.stop_bits);
  if (key == "rs485" && settings.rs485) return *settings.rs485 ? "true" : "false";
  if (key == "rate") return number(settings.rate);
  if (key == "timeout" && settings.timeout)
    return fmt::to_string(std::chrono::duration<double>(*settings.timeout).count());
  if (key == "verify") return word(settings.verify);
  if (key == "poll") return word(settings.poll);
  return std::nullopt;
}

std::vector<std::string_view> setting_names() {
  std::vector<std::string_view> names;
  for (const SettingKey& key : setting_keys) {
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
  prefer(weak.name, strong.name);
  prefer(weak.address, strong.address);
  prefer(weak.port, strong.port);
  prefer(weak.unit, strong.unit);
  prefer(weak.framing, strong.framing);
  prefer(weak.serial, strong.serial);
  prefer(weak.baud, strong.baud);
  prefer(weak.parity, strong.parity);
  prefer(weak.stop_bits, strong.stop_bits);
  prefer(weak.rs485, strong.rs485);
  prefer(weak.rate, strong.rate);
  prefer(weak.timeout, strong.timeout);
  prefer(weak.verify, strong.verify);
  prefer(weak.poll, strong.poll);
  return weak;
}

Settings with_map(Settings settings, const Map& map) {
  settings.name = std::string(map.name);
  const auto& [address, port, unit, timeout, framing, serial] = map.connection;
  settings.address = std::string(address);
  settings.port = port;
  settings.unit = unit;
  settings.framing = framing;
  settings.serial = std::string(serial.device);
  settings.baud = serial.baud;
  settings.parity = serial.parity;
  settings.stop_bits = serial.stop_bits;
  settings.rs485 = serial.rs485;
  settings.timeout = timeout;
  settings.rate = map.polling.rate;
  settings.verify = map.verify;
  settings.poll = map.poll;
  return settings;
}

void apply(const Settings& settings, Map& map) {
  if (settings.name) map.name = *settings.name;
  Connection& connection = map.connection;
  const bool was_rtu = connection.is_rtu();
  if (settings.address) {
    connection.address = *settings.address;
    connection.framing = Framing::tcp;
    connection.serial.device = {};
  }
  if (settings.port) connection.port = *settings.port;
  if (settings.unit) connection.unit = *settings.unit;
  if (settings.framing) connection.framing = *settings.framing;
  if (settings.serial) {
    connection.serial.device = *settings.serial;
    connection.address = {};
  }
  if (settings.baud) connection.serial.baud = *settings.baud;
  if (settings.parity) connection.serial.parity = *settings.parity;
  if (settings.stop_bits) connection.serial.stop_bits = *settings.stop_bits;
  if (settings.rs485) connection.serial.rs485 = *settings.rs485;
  connection.changed_from(was_rtu);
  if (settings.timeout) connection.timeout = *settings.timeout;
  if (settings.rate) map.polling.rate = *settings.rate;
  if (settings.poll) map.poll = *settings.poll;
  if (settings.verify) map.verify = *settings.verify;
}

}  // namespace coupler::host
