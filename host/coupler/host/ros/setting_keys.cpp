// SPDX-License-Identifier: Apache-2.0
// The table of settings. Each row says how a setting is read from text, and where it stands in the map.
#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <type_traits>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "coupler/base/enumeration.hpp"
#include "coupler/host/ros/settings.hpp"
#include "coupler/map/loader/keys.hpp"
#include "coupler/map/loader/names.hpp"
#include "coupler/map/loader/scalar.hpp"
#include "coupler/map/network.hpp"
#include "coupler/map/node_address.hpp"

namespace coupler::host {
namespace {

using Kind = SettingKey::Kind;
using std::chrono::milliseconds;

/// Makes a value of a text. The error says what the value should have been.
template <class T>
using Parse = std::function<tl::expected<T, std::string>(const SettingKey& key, const std::string& text)>;

tl::unexpected<std::string> wrong(const SettingKey& key, const std::string& text, std::string_view expected) {
  return tl::make_unexpected(fmt::format("{}: '{}' is not {}", key.key, text, expected));
}

std::string to_text(const std::string& value) { return value; }
std::string to_text(const std::vector<std::string>& value) {
  return fmt::format("{}", fmt::join(value, ","));
}
std::string to_text(bool value) { return value ? "true" : "false"; }
std::string to_text(milliseconds value) {
  return fmt::format("{}s", std::chrono::duration<double>(value).count());
}
template <class T>
std::string to_text(T value) {
  if constexpr (std::is_enum_v<T>)
    return std::string(coupler::to_string(value));
  else
    return fmt::to_string(value);
}

SettingKey text_key(std::string_view key, std::string_view help, std::string_view alias = {}) {
  return {key, alias, Kind::text, 0, 0, "", help};
}
SettingKey whole_key(std::string_view key, double min, double max, std::string_view help) {
  return {key, "", Kind::integer, min, max, "", help};
}
SettingKey real_key(std::string_view key, double min, double max, std::string_view unit,
                    std::string_view help) {
  return {key, "", Kind::real, min, max, unit, help};
}

/// Returns the row of a setting that has no place in the map. `key` already has its name, range and help.
template <class T>
SettingKey row(SettingKey key, std::optional<T> Settings::*field, const Parse<T>& parse) {
  SettingKey row = key;
  row.set = [key = std::move(key), field, parse](Settings& settings,
                                                 const std::string& text) -> tl::expected<void, std::string> {
    auto value = parse(key, text);
    if (!value) return tl::make_unexpected(value.error());
    settings.*field = *std::move(value);
    return {};
  };
  row.text = [field](const Settings& settings) {
    return settings.*field ? std::optional(to_text(*(settings.*field))) : std::nullopt;
  };
  row.prefer = [field](Settings& weak, const Settings& strong) {
    if (strong.*field) weak.*field = strong.*field;
  };
  return row;
}

/// Returns the row of a setting that also has a place in the map.
template <class T, class Place>
SettingKey row(SettingKey key, std::optional<T> Settings::*field, const Parse<T>& parse, Place place) {
  SettingKey row = host::row(std::move(key), field, parse);
  row.from_map = [field, place](Settings& settings, Map& map) { settings.*field = T(place(map)); };
  row.to_map = [field, place](const Settings& settings, Map& map) {
    if (settings.*field) place(map) = *(settings.*field);
  };
  return row;
}

/// Returns the row of a TLS setting. Only apply() writes these to the map, all together, because an authority
/// and a pin exclude each other.
SettingKey tls_row(std::string_view key, std::string_view help, std::optional<std::string> Settings::*field,
                   const Parse<std::string>& parse, std::string_view Tls::*place) {
  SettingKey row = host::row(text_key(key, help), field, parse,
                             [place](Map& map) -> std::string_view& { return map.connection.tls.*place; });
  row.to_map = nullptr;
  return row;
}

std::optional<double> number_in(const std::string& text) {
  char* end = nullptr;
  errno = 0;
  const double value = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0' || errno != 0 || !std::isfinite(value)) return std::nullopt;
  return value;
}

/// A number in the key's range.
template <class T>
tl::expected<T, std::string> number(const SettingKey& key, const std::string& text) {
  const auto value = number_in(text);
  const bool is_integer = key.kind == Kind::integer;
  if (!value || *value < key.min || *value > key.max || (is_integer && *value != std::floor(*value)))
    return wrong(key, text,
                 fmt::format("a {} from {} to {}{}", is_integer ? "whole number" : "number", key.min, key.max,
                             key.unit));
  return static_cast<T>(*value);
}

/// Seconds, or a duration with its unit, as a map has it. Large bare numbers were meant as milliseconds.
tl::expected<milliseconds, std::string> duration(const SettingKey& key, const std::string& text) {
  const auto bare = number_in(text);
  if (bare && *bare > loader::most_bare_seconds)
    return wrong(key, text,
                 *bare <= key.max
                     ? fmt::format("a number of seconds up to {}; write {}ms or {}s",
                                   loader::most_bare_seconds, text, text)
                     : fmt::format("a number of seconds up to {}; write {}ms if these are milliseconds",
                                   loader::most_bare_seconds, text));
  const auto value = loader::parse_duration(bare ? text + "s" : text);
  const double seconds = value ? std::chrono::duration<double>(*value).count() : -1;
  if (seconds < key.min || seconds > key.max)
    return wrong(key, text,
                 fmt::format("a duration from {} to {}{}, as 0.5, 500ms or 3s", key.min, key.max, key.unit));
  return milliseconds(std::lround(seconds * 1000));
}

tl::expected<std::uint32_t, std::string> rate_of_line(const SettingKey& key, const std::string& text) {
  auto baud = number<std::uint32_t>(key, text);
  if (!baud || is_serial_rate(*baud)) return baud;
  return wrong(key, text, fmt::format("one of {}", fmt::join(serial_rates, ", ")));
}

/// One of the words of a map.
template <class T>
tl::expected<T, std::string> word(const SettingKey& key, const std::string& text) {
  // ROS reads "off" as a boolean where a parameter comes from YAML.
  if (const auto value = parse_word<T>(text == "false" ? "off" : text)) return *value;
  std::string words;
  const auto& all = enumeration_of<T>.words;
  for (const Word<T>& one : all) {
    const std::string_view between = &one == &all[0] ? "" : &one == std::end(all) - 1 ? " or " : ", ";
    words += fmt::format("{}{}", between, one.word);
  }
  return wrong(key, text, words);
}

tl::expected<bool, std::string> boolean(const SettingKey& key, const std::string& text) {
  if (text == "true" || text == "false") return text == "true";
  return wrong(key, text, "true or false");
}

tl::expected<std::string, std::string> map_place(const SettingKey& key, const std::string& text) {
  if (!text.empty()) return text;
  return wrong(key, text, "a path or tcp://HOST; leave the setting out if there is none");
}

tl::expected<std::string, std::string> ros_name(const SettingKey& key, const std::string& text) {
  if (loader::is_relative_ros_name(text)) return text;
  return wrong(key, text, "a name in ROS: a letter, then letters, digits, '_' and '/'");
}

tl::unexpected<std::string> no_host(const SettingKey& key, const std::string& text, const NetworkError& why) {
  return tl::make_unexpected(fmt::format("{}: '{}' {}; {}", key.key, text, why.what, why.remedy));
}

/// Without the brackets of an IPv6 address.
tl::expected<std::string, std::string> host_address(const SettingKey& key, const std::string& text) {
  const auto host = parse_host(text);
  if (!host) return no_host(key, text, host.error());
  return std::string(*host);
}

tl::expected<std::string, std::string> host_name(const SettingKey& key, const std::string& text) {
  const auto host = parse_host(text);
  if (!host) return no_host(key, text, host.error());
  return text;
}

tl::expected<std::string, std::string> device_file(const SettingKey& key, const std::string& text) {
  if (!text.empty() && !names_a_node(text)) return text;
  return wrong(key, text, "a device file, as /dev/ttyUSB0; its unit and baud rate are settings of their own");
}

/// Returns the absolute path of a file. A relative one starts in the working directory, not beside the map.
tl::expected<std::string, std::string> file(const SettingKey& key, const std::string& text) {
  if (text.empty()) return wrong(key, text, "a path; leave the setting out if there is none");
  return std::filesystem::absolute(text).string();
}

tl::expected<std::string, std::string> pin(const SettingKey& key, const std::string& text) {
  if (is_pin(text)) return text;
  return wrong(key, text, "'sha256:' and 64 hexadecimal digits, as `coupler pin` prints them");
}

std::string_view without(std::string_view text, std::string_view front, std::string_view back) {
  const std::size_t from = text.find_first_not_of(front);
  if (from == std::string_view::npos) return {};
  return text.substr(from, text.find_last_not_of(back) - from + 1);
}

tl::expected<std::vector<std::string>, std::string> names(const SettingKey& key, const std::string& text) {
  auto items = items_of(text);
  if (items.empty()) return wrong(key, text, "a list of names, as in [pump_*,tank/*]");
  return items;
}

/// Completes the row of `maps`, a list. Its `prefer` does nothing, because overlay() treats `map` and `maps`
/// as one setting.
SettingKey maps_row(SettingKey row) {
  row.set = [key = row](Settings& settings, const std::string& text) -> tl::expected<void, std::string> {
    settings.maps = items_of(text);
    if (settings.maps.empty()) return wrong(key, text, "a list of paths, as in [a.yaml,b.yaml]");
    return {};
  };
  row.text = [](const Settings& settings) {
    return settings.maps.empty() ? std::nullopt : std::optional(to_text(settings.maps));
  };
  row.prefer = [](Settings& /*weak*/, const Settings& /*strong*/) {};
  return row;
}

}  // namespace

std::vector<std::string> items_of(std::string_view list) {
  std::vector<std::string> items;
  for (std::string_view rest = without(list, " [", " ]"); !rest.empty();) {
    const std::size_t comma = std::min(rest.find(','), rest.size());
    const std::string_view item = without(rest.substr(0, comma), " '\"", " '\"");
    if (!item.empty()) items.emplace_back(item);
    rest.remove_prefix(std::min(comma + 1, rest.size()));
  }
  return items;
}

// NOLINTNEXTLINE(readability-function-size): a table
const std::vector<SettingKey>& setting_keys() {
  static const std::vector<SettingKey> keys{
      row<std::string>(text_key("map",
                                "the device's map: a YAML or JSON file, or the address of a device that "
                                "serves it, as tcp:// or "
                                "tls://HOST[:PORT][/UNIT]",
                                "mapping"),
                       &Settings::map, map_place),
      maps_row({"maps", "", Kind::list, 0, 0, "",
                "several devices in one process: their maps, as in --maps a.yaml,b.yaml; with names of their "
                "own, as in "
                "--maps left=io.yaml,right=io.yaml"}),
      row<std::string>(
          text_key("name", "namespace of the topics, instead of the map's"), &Settings::name, ros_name,
          [](Map & map) -> auto& { return map.name; }),
      row<std::string>(
          text_key("address", "host name or IP address; alone, without a map: a device that serves its own"),
          &Settings::address, host_address, [](Map & map) -> auto& { return map.connection.address; }),
      row<std::uint16_t>(
          whole_key("port", 1, 65535, "TCP port; 502 if the map has none"), &Settings::port,
          number<std::uint16_t>, [](Map & map) -> auto& { return map.connection.port; }),
      row<std::uint8_t>(
          whole_key("unit", 0, 255, "unit id"), &Settings::unit, number<std::uint8_t>,
          [](Map & map) -> auto& { return map.connection.unit; }),
      row<Framing>(
          text_key("framing", "tcp, or rtu for RTU over TCP"), &Settings::framing, word<Framing>,
          [](Map & map) -> auto& { return map.connection.framing; }),
      row<std::string>(
          text_key("serial", "serial port, as /dev/ttyUSB0, instead of an address"), &Settings::serial,
          device_file, [](Map & map) -> auto& { return map.connection.serial.device; }),
      row<std::uint32_t>(
          whole_key("baud", 110, 4000000, "bits a second on the serial port"), &Settings::baud, rate_of_line,
          [](Map & map) -> auto& { return map.connection.serial.baud; }),
      row<Serial::Parity>(
          text_key("parity", "even, odd or none"), &Settings::parity, word<Serial::Parity>,
          [](Map & map) -> auto& { return map.connection.serial.parity; }),
      row<std::uint16_t>(
          whole_key("stop_bits", 1, 2, "stop bits on the serial port"), &Settings::stop_bits,
          number<std::uint16_t>, [](Map & map) -> auto& { return map.connection.serial.stop_bits; }),
      row<bool>(
          text_key("rs485", "true: the port's driver switches the direction of RS-485"), &Settings::rs485,
          boolean, [](Map & map) -> auto& { return map.connection.serial.rs485; }),
      tls_row("certificate", "file of this machine's certificate, for a device with TLS",
              &Settings::certificate, file, &Tls::certificate),
      tls_row("key", "file of its key", &Settings::key, file, &Tls::key),
      tls_row("ca", "file of the authority of the device's certificate", &Settings::ca, file, &Tls::ca),
      tls_row("tls_name", "name in the device's certificate, if not its address", &Settings::tls_name,
              host_name, &Tls::name),
      tls_row("pin", "pin of the device's certificate, instead of ca; `coupler pin` prints it",
              &Settings::pin, pin, &Tls::pin),
      row<double>(
          real_key("rate", 0.001, 10000, " Hz", "polling rate in Hz"), &Settings::rate, number<double>,
          [](Map & map) -> auto& { return map.polling.rate; }),
      row<milliseconds>(
          real_key("timeout", 0.001, 3600, " s",
                   "longest wait for a reply: seconds, up to 60, or with a unit, as 500ms or 90s"),
          &Settings::timeout, duration, [](Map & map) -> auto& { return map.connection.timeout; }),
      row<Verify>(
          text_key(
              "verify",
              "if the device's map differs: require (do not talk to it), warn (go on) or off (do not ask); "
              "instead of the map's"),
          &Settings::verify, word<Verify>, [](Map & map) -> auto& { return map.verify; }),
      row<Poll>(
          text_key(
              "poll",
              "which points are read: all (default), or subscribed: those that have subscribers; instead "
              "of the map's"),
          &Settings::poll, word<Poll>, [](Map & map) -> auto& { return map.poll; }),
      row<std::vector<std::string>>(
          {"topics", "", Kind::list, 0, 0, "",
           "the points that have topics, as in --topics 'pump_*,tank/*'; by default all, or the first 10000"},
          &Settings::topics, names),
      row<std::string>(
          text_key("record",
                   "file of a recording of every change, as `coupler record` makes it; of several "
                   "devices each has its own"),
          &Settings::record, file),
      row<std::uint16_t>(whole_key("panel", 1, 65535,
                                   "port of a live page, as `coupler panel` shows it, on this machine; of "
                                   "several devices each has the next port"),
                         &Settings::panel, number<std::uint16_t>),
  };
  return keys;
}

}  // namespace coupler::host
