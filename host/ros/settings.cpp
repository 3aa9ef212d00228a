// SPDX-License-Identifier: Apache-2.0
#include "host/ros/settings.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdlib>

#include <fmt/format.h>

#include "common/map/host.hpp"
#include "common/map/loader/nearest.hpp"

namespace coupler::driver {
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

/// A whole number from 0 to what fits into T.
template <class T>
Outcome set_whole(std::optional<T>& field, std::string_view key, const std::string& text, double smallest) {
  constexpr double largest = std::numeric_limits<T>::max();
  const auto value = number(text);
  if (!value || *value != std::floor(*value) || *value < smallest || *value > largest)
    return wrong(key, text, fmt::format("a whole number from {} to {}", smallest, largest));
  field = static_cast<T>(*value);
  return {};
}

Outcome set_rate(Settings& settings, const std::string& text) {
  const auto hertz = number(text);
  if (!hertz || *hertz < 0.001 || *hertz > 10000) return wrong("rate", text, "a rate from 0.001 to 10000 Hz");
  settings.rate = *hertz;
  return {};
}

Outcome set_timeout(Settings& settings, const std::string& text) {
  const auto seconds = number(text);
  if (!seconds || *seconds < 0.001 || *seconds > 3600)
    return wrong("timeout", text, "a time from 0.001 to 3600 s");
  settings.timeout = std::chrono::milliseconds(std::lround(*seconds * 1000));
  return {};
}

Outcome set_verify(Settings& settings, const std::string& text) {
  if (text == "require")
    settings.verify = Verify::require;
  else if (text == "warn")
    settings.verify = Verify::warn;
  // ROS reads "off" as a boolean where a parameter comes from YAML.
  else if (text == "off" || text == "false")
    settings.verify = Verify::off;
  else
    return wrong("verify", text, "require, warn or off");
  return {};
}

Outcome set_poll(Settings& settings, const std::string& text) {
  if (text != "all" && text != "subscribed") return wrong("poll", text, "all or subscribed");
  settings.poll = text == "all" ? Poll::all : Poll::subscribed;
  return {};
}

Outcome set_text(std::optional<std::string>& field, std::string_view key, const std::string& text) {
  if (text.empty()) return wrong(key, text, "a text; leave it out if there is nothing to say");
  field = text;
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

std::string_view without(std::string_view text, std::string_view front, std::string_view back) {
  const std::size_t from = text.find_first_not_of(front);
  if (from == std::string_view::npos) return {};
  return text.substr(from, text.find_last_not_of(back) - from + 1);
}

/// "a.yaml,b.yaml", also as YAML has it: [a.yaml, "b.yaml"].
Outcome set_list(std::vector<std::string>& field, std::string_view key, const std::string& text) {
  std::string_view rest = without(text, " [", " ]");
  field.clear();
  while (!rest.empty()) {
    const std::size_t comma = std::min(rest.find(','), rest.size());
    const std::string_view item = without(rest.substr(0, comma), " '\"", " '\"");
    if (!item.empty()) field.emplace_back(item);
    rest.remove_prefix(std::min(comma + 1, rest.size()));
  }
  if (field.empty()) return wrong(key, text, "a list of paths, as in [a.yaml,b.yaml]");
  return {};
}

template <class T>
void prefer(std::optional<T>& field, const std::optional<T>& strong) {
  if (strong) field = strong;
}

}  // namespace

const std::array<SettingKey, 10> setting_keys{{
    {"map", "mapping", "the device's map: a YAML or JSON file, or tcp://HOST[:PORT][/UNIT] of a node"},
    {"maps", "",
     "several devices in one process: their maps, as in --maps a.yaml,b.yaml; with names of their own, as in "
     "--maps left=io.yaml,right=io.yaml"},
    {"name", "", "namespace of the topics, instead of the map's"},
    {"address", "", "host name or IP address; alone, without a map: a node that serves its own"},
    {"port", "", "TCP port, 502 if the map says nothing"},
    {"unit", "", "unit id"},
    {"rate", "", "polling rate in Hz"},
    {"timeout", "", "longest wait for a reply, in seconds"},
    {"verify", "",
     "if the node's map differs: require (default: do not talk to it), warn (go on) or off (do not ask)"},
    {"poll", "",
     "which points are read: all (default), or subscribed: those that somebody listens to; instead of the "
     "map's"},
}};

Outcome set(Settings& settings, std::string_view key, const std::string& text) {
  if (key == "map") return set_text(settings.map, key, text);
  if (key == "maps") return set_list(settings.maps, key, text);
  if (key == "name") return set_text(settings.name, key, text);
  if (key == "address") return set_address(settings, text);
  if (key == "port") return set_whole(settings.port, key, text, 1);
  if (key == "unit") return set_whole(settings.unit, key, text, 0);
  if (key == "rate") return set_rate(settings, text);
  if (key == "timeout") return set_timeout(settings, text);
  if (key == "verify") return set_verify(settings, text);
  if (key == "poll") return set_poll(settings, text);
  return tl::make_unexpected(fmt::format("{}: {}", key, no_such_setting(key)));
}

std::vector<std::string_view> setting_names() {
  std::vector<std::string_view> names;
  for (const SettingKey& key : setting_keys) {
    names.push_back(key.key);
    if (!key.alias.empty()) names.push_back(key.alias);
  }
  return names;
}

std::string no_such_setting(std::string_view name) {
  return "there is no such setting; " +
         loader::nearest_or(name, setting_names(), "coupler_driver --help shows them");
}

Settings overlay(Settings weak, const Settings& strong) {
  if (strong.map || !strong.maps.empty()) {
    weak.map = strong.map;
    weak.maps = strong.maps;
  }
  prefer(weak.name, strong.name);
  prefer(weak.address, strong.address);
  prefer(weak.port, strong.port);
  prefer(weak.unit, strong.unit);
  prefer(weak.rate, strong.rate);
  prefer(weak.timeout, strong.timeout);
  prefer(weak.verify, strong.verify);
  prefer(weak.poll, strong.poll);
  return weak;
}

void apply(const Settings& settings, Map& map) {
  if (settings.name) map.name = *settings.name;
  if (settings.address) map.connection.address = *settings.address;
  if (settings.port) map.connection.port = *settings.port;
  if (settings.unit) map.connection.unit = *settings.unit;
  if (settings.timeout) map.connection.timeout = *settings.timeout;
  if (settings.rate) map.polling.rate = *settings.rate;
  if (settings.poll) map.poll = *settings.poll;
}

}  // namespace coupler::driver
