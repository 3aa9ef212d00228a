// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/ros1/arguments.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "coupler/base/starts_with.hpp"
#include "coupler/host/ros/left_out_of_build.hpp"
#include "coupler/host/ros/program.hpp"

namespace coupler::host {
namespace {

constexpr const char* help =
    "Each option is also a private parameter (~rate) and a ROS argument (_rate:=20).\n"
    "A setting of one device of several has the name in its map before it: _NAME/rate:=20, ~NAME/rate.\n"
    "Precedence: map < parameter < argument; a setting of one device wins over the same one of all.\n\n"
    "Examples:\n"
    "  coupler_driver _map:=device.yaml\n"
    "  coupler_driver --map device.yaml --address 192.168.10.101 --rate 50\n"
    "  coupler_driver _address:=raspberrypi        (a device that serves its map)\n"
    "  coupler_driver --map gripper.yaml --serial /dev/ttyUSB0\n"
    "  coupler_driver _maps:=[press.yaml,belt.yaml] _belt/address:=192.168.10.102\n"
    "  rostopic echo /device/in_A\n"
    "  rostopic pub -1 /device/out_Z/write std_msgs/Bool true";

/// `_device/key:=VALUE`
struct DeviceArgument {
  std::string_view device;
  std::string_view key;
  std::string_view value;
};

/// The arguments by kind.
struct SortedArguments {
  std::vector<std::string> options;  ///< as `--key VALUE` or `--key=VALUE`
  std::vector<DeviceArgument> of_devices;
  std::vector<std::string_view> unknown;  ///< `_key:=VALUE` that is not a setting
  std::vector<char*> for_ros;
  bool names_the_node = false;
  bool by_roslaunch = false;
};

SortedArguments sort(Span<char* const> arguments) {
  SortedArguments result;
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
        // ROS makes a parameter of it, and an empty one counts as not given.
        if (!value.empty()) result.options.push_back(fmt::format("--{}={}", name, value));
      } else {
        result.of_devices.push_back({name.substr(0, slash), name.substr(slash + 1), value});
        result.for_ros.pop_back();
      }
    } else if (starts_with(argument, "__name:=")) {
      result.names_the_node = true;
    } else if (starts_with(argument, "__log:=")) {
      result.by_roslaunch = true;
    }
  }
  return result;
}

tl::expected<void, std::string> set_of_device(Settings& settings, const DeviceArgument& given) {
  if (given.value.empty() && is_setting(given.key)) return {};
  if (given.key == "map" || given.key == "maps")
    return tl::make_unexpected(fmt::format(
        "_{}/{}: a map is not a setting of one device; give the maps as in _maps:=[a.yaml,b.yaml]",
        given.device, given.key));
  if (const auto done = set(settings, given.key, std::string(given.value)); !done)
    return tl::make_unexpected(fmt::format("_{}/{}", given.device, done.error()));
  return {};
}

}  // namespace

const Dialect ros1_dialect{
    help,
    "as in _NAME/address:=HOST (NAME being the map's name), or as a parameter ~NAME/address",
    "a relative path counts from the folder where the program starts",
    left_out_of_build,
};

const Dialect roslaunch_dialect{
    ros1_dialect.help,
    ros1_dialect.device_setting,
    "roslaunch starts programs in that folder (ROS_HOME): give the whole path, as in map:=$PWD/{path} or "
    "$(find PACKAGE)/{path}",
    left_out_of_build,
};

Arguments parse_arguments(Span<char* const> arguments) {
  SortedArguments given = sort(arguments);
  Arguments result{parse_options(std::move(given.options), ros1_dialect), {}, {}, false, given.by_roslaunch};
  result.names_the_node = given.names_the_node;
  result.for_ros = std::move(given.for_ros);
  if (result.exit_code == 0) return result;
  const auto refuse = [&](const std::string& why) {
    result.exit_code = wrong_call;
    result.text += why + "\n";
  };
  for (const std::string_view one : given.unknown)
    refuse(fmt::format("{}: {}", one, no_such_setting(one.substr(1, one.find(":=") - 1))));
  for (const DeviceArgument& one : given.of_devices)
    if (const auto done = set_of_device(result.of_devices[std::string(one.device)], one); !done)
      refuse(done.error());
  return result;
}

}  // namespace coupler::host
