// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/ros2/arguments.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>

#include "coupler/base/starts_with.hpp"
#include "coupler/host/ros/left_out_of_build.hpp"
#include "coupler/host/ros/program.hpp"

namespace coupler::host {
namespace {

constexpr std::string_view help =
    "Each option is also a parameter of the node (rate): --ros-args -p rate:=20, --params-file FILE.\n"
    "A setting of one device of several is a parameter with the name in its map before it: NAME.rate.\n"
    "Precedence: map < parameter < option; a setting of one device wins over the same one of all.\n"
    "ROS 2's own arguments come after --ros-args: -r (remapping), --log-level, --enclave and others.\n\n"
    "Examples:\n"
    "  coupler_driver --map device.yaml\n"
    "  coupler_driver --map device.yaml --address 192.168.10.101 --rate 50\n"
    "  coupler_driver --address raspberrypi        (a device that serves its map)\n"
    "  ros2 run coupler_driver coupler_driver --ros-args -p map:=$PWD/device.yaml -r __ns:=/cell\n"
    "  coupler_driver --map gripper.yaml --serial /dev/ttyUSB0\n"
    "  coupler_driver --maps press.yaml,belt.yaml --ros-args -p belt.address:=192.168.10.102\n"
    "  ros2 topic echo /device/in_A\n"
    "  ros2 topic pub -1 /device/out_Z/write std_msgs/msg/Bool '{data: true}'";

/// How ROS 2 spells an assignment of ROS 1, `from:=to`.
std::string in_ros2(std::string_view assignment) {
  if (starts_with(assignment, "__name:=")) return fmt::format("-r __node:={}", assignment.substr(8));
  if (starts_with(assignment, "__") || !starts_with(assignment, "_")) return fmt::format("-r {}", assignment);
  std::string parameter(assignment.substr(1));
  const std::size_t assign = parameter.find(":=");
  const std::size_t slash = parameter.rfind('/', assign);
  if (slash != std::string::npos) parameter[slash] = '.';
  return "-p " + parameter;
}

/// ROS 2's own arguments, apart from those that are whole in one word.
constexpr std::array<std::string_view, 10> with_a_value{
    "-p",        "--param",       "-r",          "--remap",           "-e",
    "--enclave", "--params-file", "--log-level", "--log-config-file", "--log-file-name"};
constexpr std::array<std::string_view, 6> without_a_value{
    "--enable-rosout-logs",  "--disable-rosout-logs",      "--enable-stdout-logs",
    "--disable-stdout-logs", "--enable-external-lib-logs", "--disable-external-lib-logs"};

template <class Words>
bool is_among(const Words& words, std::string_view argument) {
  return std::find(words.begin(), words.end(), argument) != words.end();
}

bool has(std::string_view text, std::string_view part) { return text.find(part) != std::string_view::npos; }

bool is_ROS1s(std::string_view argument) { return has(argument, ":=") && !starts_with(argument, "-"); }

}  // namespace

const Dialect ros2_dialect{
    help,
    "as a parameter, as in --ros-args -p NAME.address:=HOST (NAME being the map's name)",
    "a relative path counts from the folder where the program starts; in a launch file give the whole path",
    left_out_of_build,
};

Arguments parse_arguments(Span<char* const> arguments) {
  Arguments result;
  std::vector<std::string> options;
  result.for_ros.emplace_back(arguments[0]);
  bool is_for_ros = false;
  std::string wrong;
  bool follows_misplaced = false;
  for (const char* const raw : arguments.from(1)) {
    const std::string_view argument(raw);
    if (std::exchange(follows_misplaced, false)) continue;
    if (argument == "--ros-args") {
      is_for_ros = true;
      result.for_ros.emplace_back(argument);
    } else if (is_for_ros) {
      is_for_ros = argument != "--";
      result.for_ros.emplace_back(argument);
      result.names_the_node |= starts_with(argument, "__node:=") || starts_with(argument, "__name:=");
    } else if (is_among(with_a_value, argument) || is_among(without_a_value, argument)) {
      wrong += fmt::format("{}: arguments of ROS 2 come after --ros-args\n", argument);
      follows_misplaced = is_among(with_a_value, argument);
    } else if (is_ROS1s(argument)) {
      wrong += fmt::format("{}: that is ROS 1's spelling; in ROS 2 write --ros-args {}\n", argument,
                           in_ros2(argument));
    } else {
      options.emplace_back(argument);
    }
  }
  if (!wrong.empty()) {
    result.exit_code = wrong_call;
    result.text = std::move(wrong);
    return result;
  }
  static_cast<Options&>(result) = parse_options(std::move(options), ros2_dialect);
  return result;
}

std::vector<Remapping> remappings_of(const std::vector<std::string>& for_ros, std::string_view node) {
  std::vector<Remapping> result;
  for (std::size_t i = 1; i < for_ros.size(); ++i) {
    if (for_ros[i - 1] != "-r" && for_ros[i - 1] != "--remap") continue;
    const std::size_t assign = for_ros[i].find(":=");
    if (assign == std::string::npos) continue;
    std::string_view from = std::string_view(for_ros[i]).substr(0, assign);
    // [NODE:][rostopic://]FROM
    const std::size_t colon = from.find(':');
    if (colon != std::string_view::npos && from.substr(colon, 3) != "://") {
      if (from.substr(0, colon) != node) continue;
      from.remove_prefix(colon + 1);
    }
    if (const std::size_t scheme = from.find("://"); scheme != std::string_view::npos)
      from.remove_prefix(scheme + 3);
    if (!starts_with(from, "__")) result.push_back({std::string(from), for_ros[i].substr(assign + 2)});
  }
  return result;
}

std::string_view remedy_of(std::string_view refusal) {
  if (has(refusal, "does not know this argument")) return "options of the driver come before --ros-args";
  if (has(refusal, "parameter override rule")) {
    if (!has(refusal, ":=")) return "write it as -p NAME:=VALUE, as in -p rate:=20";
    return "put a value that is not valid YAML into quotes, as in -p address:=\"'[::1]'\"";
  }
  if (has(refusal, "Error opening")) return "give the path of a file that can be read";
  if (has(refusal, "params file"))
    return "the file is YAML, as in /press_driver: {ros__parameters: {address: '[::1]'}}, with such quotes "
           "around "
           "a value that is not valid YAML";
  if (has(refusal, "remap rule"))
    return "write it as -r FROM:=TO, as in -r __node:=press_driver or -r __ns:=/cell; names have letters, "
           "digits "
           "and '_'";
  if (has(refusal, "log level")) return "the levels are debug, info, warn, error and fatal";
  return {};
}

}  // namespace coupler::host
