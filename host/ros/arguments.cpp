// SPDX-License-Identifier: Apache-2.0
#include "host/ros/arguments.hpp"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "common/base/version.hpp"
#include "common/command_line/command_line.hpp"

namespace coupler::driver {
namespace {

constexpr const char* description =
    "Drives a Modbus/TCP coupler: every point of its map becomes a ROS topic <name>/<point>, every writable "
    "one also\n"
    "listens to <name>/<point>/write.";

constexpr const char* examples =
    "Each option is also a private parameter (~rate) and, as ROS has it, an argument (_rate:=20).\n"
    "What is said of one device of several has the name in its map before it: _NAME/rate:=20, ~NAME/rate.\n"
    "Precedence: map < parameter < argument, what is said of one device over what is said of all.\n\n"
    "Examples:\n"
    "  coupler_driver _map:=device.yaml\n"
    "  coupler_driver --map device.yaml --address 192.168.10.101 --rate 50\n"
    "  coupler_driver _address:=raspberrypi        (a node that serves its map)\n"
    "  coupler_driver _maps:=[press.yaml,belt.yaml] _belt/address:=192.168.10.102\n"
    "  rostopic echo /device/in_A\n"
    "  rostopic pub -1 /device/out_Z/write std_msgs/Bool true";

bool starts_with(std::string_view text, std::string_view with) { return text.substr(0, with.size()) == with; }

/// What was given in ROS's spelling, `_key:=VALUE`.
struct Assignment {
  std::string_view device;  ///< of `_device/key:=VALUE`
  std::string_view key;
  std::string_view value;
};

/// What the arguments are.
struct Sorted {
  std::vector<std::string> options;  ///< as `--key VALUE` or `--key=VALUE`
  std::vector<Assignment> of_devices;
  std::vector<std::string_view> unknown;  ///< `_key:=VALUE` of no setting
  std::vector<char*> for_ros;
  bool names_the_node = false;
};

bool is_setting(std::string_view name) {
  const auto names = setting_names();
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// ROS's own are left out.
Sorted sorted(Span<char* const> arguments) {
  Sorted result;
  result.for_ros.push_back(arguments[0]);
  for (char* const raw : arguments.from(1)) {
    const std::string_view argument(raw);
    result.for_ros.push_back(raw);
    const std::size_t assign = argument.find(":=");
    if (assign == std::string_view::npos) {
      result.options.emplace_back(argument);
    } else if (argument[0] == '_' && !starts_with(argument, "__")) {
      const std::string_view name = argument.substr(1, assign - 1);
      const std::string_view value = argument.substr(assign + 2);
      const std::size_t slash = name.rfind('/');
      if (slash == std::string_view::npos && !is_setting(name)) {
        result.unknown.push_back(argument);
      } else if (slash == std::string_view::npos) {
        result.options.push_back(fmt::format("--{}={}", name, value));
      } else {
        result.of_devices.push_back({name.substr(0, slash), name.substr(slash + 1), value});
        result.for_ros.pop_back();
      }
    } else if (starts_with(argument, "__name:=")) {
      result.names_the_node = true;
    }
  }
  return result;
}

tl::expected<void, std::string> set_of_device(Settings& settings, const Assignment& given) {
  if (given.key == "map" || given.key == "maps")
    return tl::make_unexpected(
        fmt::format("_{}/{}: the maps are given as in _maps:=[a.yaml,b.yaml]", given.device, given.key));
  if (const auto done = set(settings, given.key, std::string(given.value)); !done)
    return tl::make_unexpected(fmt::format("_{}/{}", given.device, done.error()));
  return {};
}

std::string option_names(const SettingKey& key) {
  return key.alias.empty() ? fmt::format("--{}", key.key) : fmt::format("--{},--{}", key.key, key.alias);
}

}  // namespace

Arguments parse_arguments(Span<char* const> arguments) {
  Arguments result;
  Sorted given = sorted(arguments);
  result.names_the_node = given.names_the_node;
  result.for_ros = std::move(given.for_ros);
  command_line::Program app(description, "coupler_driver");
  app.version(fmt::format("coupler_driver {}", version));
  app.footer(examples);
  std::array<std::string, setting_keys.size()> texts;
  std::vector<command_line::Option> options;
  for (std::size_t i = 0; i < texts.size(); ++i)
    options.push_back(
        app.add_option(option_names(setting_keys[i]), texts[i], std::string(setting_keys[i].help)));
  result.exit_code = app.parse(std::move(given.options), result.text);
  if (result.exit_code) return result;
  const auto check = [&](const tl::expected<void, std::string>& done) {
    if (done) return;
    result.exit_code = 2;
    result.text += done.error() + "\n";
  };
  for (const std::string_view one : given.unknown)
    check(
        tl::make_unexpected(fmt::format("{}: {}", one, no_such_setting(one.substr(1, one.find(":=") - 1)))));
  for (std::size_t i = 0; i < texts.size(); ++i)
    if (options[i].given()) check(set(result.settings, setting_keys[i].key, texts[i]));
  for (const Assignment& one : given.of_devices)
    check(set_of_device(result.of_devices[std::string(one.device)], one));
  return result;
}

}  // namespace coupler::driver
