// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/ros/program.hpp"

#include <ros/exceptions.h>
#include <ros/init.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "coupler/base/standard_files.hpp"
#include "coupler/host/ros/configuration.hpp"
#include "coupler/host/ros/drive.hpp"
#include "coupler/host/ros/ending.hpp"
#include "coupler/host/ros1/arguments.hpp"
#include "coupler/host/ros1/node.hpp"
#include "coupler/host/ros1/ros_log.hpp"
#include "coupler/host/ros1/ros_parameters.hpp"

namespace coupler::host {
namespace {

/// The name is overridden by `__name`. ROS takes SIGINT. False after telling what ROS does not take.
bool init_ros(std::vector<char*> argv, const std::string& name) {
  int argc = static_cast<int>(argv.size());
  try {
    ros::init(argc, argv.data(), name);
  } catch (const ros::InvalidNameException& error) {
    print(fmt::format("{}; what is said of one device begins with '_', as in _press/address:=HOST",
                      error.what()));
    return false;
  }
  ros::start();  // here, or else the end of the first NodeHandle ends ROS
  std::signal(SIGTERM, [](int) { ros::requestShutdown(); });
  return true;
}

/// A line for each name that no map has and arguments are for.
std::string strangers(const std::vector<MapSource>& sources, const Arguments& arguments) {
  const std::vector<std::string_view> names = names_of(sources);
  std::string told;
  for (const auto& [name, settings] : arguments.of_devices)
    if (std::find(names.begin(), names.end(), name) == names.end())
      told += fmt::format("{}there are arguments for '{}'; the maps themselves have the names {}",
                          told.empty() ? "" : "\ncoupler_driver: ", name, fmt::join(names, ", "));
  return told;
}

/// Precedence: map < parameter ~key < parameter ~NAME/key, where there are several devices < argument <
/// argument for the device. The error is the exit code.
tl::expected<Devices, int> configure(std::vector<MapSource> sources, const Arguments& arguments) {
  if (const std::string wrong = strangers(sources, arguments); !wrong.empty()) {
    print(wrong);
    return tl::make_unexpected(wrong_call);
  }
  const bool several = sources.size() > 1;
  for (const std::string& line :
       unknown_parameters(several ? names_of(sources) : std::vector<std::string_view>()))
    ros_log(Level::warning, line);
  const auto common = read_parameters(ros::NodeHandle("~"));
  const auto settings_of = [&](std::string_view name) {
    auto settings = common;
    if (settings && several) {
      const auto own = read_parameters(ros::NodeHandle("~" + std::string(name)));
      settings = own ? overlay(*settings, *own) : own;
    }
    if (!settings) return settings;
    settings = overlay(*settings, arguments.settings);
    const auto own = arguments.of_devices.find(std::string(name));
    if (own != arguments.of_devices.end()) settings = overlay(*settings, own->second);
    return settings;
  };
  auto devices = configure(std::move(sources), settings_of);
  std::string wrong = devices ? why_not(*devices) : devices.error();
  if (wrong.empty()) return std::move(*devices);
  print(wrong);
  return tl::make_unexpected(wrong_input);
}

}  // namespace

int main_with(const Map* built_in, int argc, char** argv) {
  open_standard_files();
  std::setvbuf(stdout, nullptr, _IOLBF, 0);  // ROS_INFO is to be seen in a pipe and in the journal too
  Ending::at_once_on_signals();
  const Arguments arguments = parse_arguments({argv, static_cast<std::size_t>(argc)});
  if (arguments.exit_code) {
    fmt::print(*arguments.exit_code == 0 ? stdout : stderr, "{}", arguments.text);
    return *arguments.exit_code;
  }
  Settings settings = arguments.settings;
  // A node that was given its name (by roslaunch, say) may have its map in its parameters. Otherwise the map
  // gives the name, and the parameters are those of that name.
  if (arguments.names_the_node) {
    if (!init_ros(arguments.for_ros, "coupler_driver")) return wrong_call;
    const auto parameters = read_parameters(ros::NodeHandle("~"));
    if (!parameters) {
      print(parameters.error());
      return wrong_input;
    }
    settings = overlay(*parameters, arguments.settings);
  }
  auto sources = find_maps(built_in, settings, ros1_dialect,
                           [](Level /*level*/, const std::string& text) { print(text); });
  if (!sources) return sources.error();
  const std::string name =
      node_name(arguments.settings.name.value_or(std::string(sources->front().map.name)));
  if (!arguments.names_the_node && !init_ros(arguments.for_ros, name)) return wrong_call;
  const auto devices = configure(std::move(*sources), arguments);
  if (!devices) return devices.error();
  // roscpp would shut down in a thread of its own, while this one still uses it.
  Ending::in_order_on_signals();
  Ros1Node node;
  return drive(*devices, node);
}

}  // namespace coupler::host
