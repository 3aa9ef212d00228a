// SPDX-License-Identifier: Apache-2.0
#include "host/ros/program.hpp"

#include <ros/init.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>

#include <fmt/format.h>

#include "host/ros/arguments.hpp"
#include "host/ros/device_topics.hpp"
#include "host/ros/map_source.hpp"
#include "host/ros/ros_parameters.hpp"

namespace coupler::driver {
namespace {

constexpr int wrong_input = 1;

void print(std::string_view text) { fmt::print(stderr, "coupler_driver: {}\n", text); }

/// Until ROS is there nothing has been started that would have to be ended.
void end_at_once_on_signals() {
  const auto end = [](int) { ::_exit(0); };
  std::signal(SIGINT, end);
  std::signal(SIGTERM, end);
}

/// `<name>_driver`: two drivers must not have one name, or the master shuts the first down.
std::string node_name(std::string_view map_name) {
  std::string name = fmt::format("{}_driver", map_name);
  std::replace(name.begin(), name.end(), '/', '_');
  return name;
}

/// The name is overridden by `__name`. ROS takes SIGINT.
void init_ros(int argc, char** argv, const std::string& name) {
  ros::init(argc, argv, name);
  ros::start();  // here, or else the end of the first NodeHandle ends ROS
  std::signal(SIGTERM, [](int) { ros::requestShutdown(); });
}

tl::expected<Settings, int> with_parameters(const Settings& arguments) {
  const auto parameters = read_parameters(ros::NodeHandle("~"));
  if (parameters) return overlay(*parameters, arguments);
  print(parameters.error());
  return tl::make_unexpected(wrong_input);
}

int run(const Map& map, Verify verify) {
  if (map.connection.address.empty()) {
    print("the map has no address; add 'address: HOST' or give _address:=HOST");
    return wrong_input;
  }
  ros::NodeHandle handle;
  DeviceTopics device(handle, map, verify);
  ros::waitForShutdown();
  ros::shutdown();
  return 0;
}

}  // namespace

int main_with(const Map* built_in, int argc, char** argv) {
  std::setvbuf(stdout, nullptr, _IOLBF, 0);  // ROS_INFO is to be seen in a pipe and in the journal too
  end_at_once_on_signals();
  const Arguments arguments = parse_arguments({argv, static_cast<std::size_t>(argc)});
  if (arguments.exit_code) {
    fmt::print(*arguments.exit_code == 0 ? stdout : stderr, "{}", arguments.text);
    return *arguments.exit_code;
  }
  Settings settings = arguments.settings;
  // A node that was given its name (by roslaunch, say) may have its map in its parameters. Otherwise the map
  // gives the name, and the parameters are those of that name.
  if (arguments.names_the_node) {
    init_ros(argc, argv, "coupler_driver");
    const auto all = with_parameters(arguments.settings);
    if (!all) return all.error();
    settings = *all;
  }
  auto source = find_map(built_in, settings);
  if (!source) return source.error();
  if (!arguments.names_the_node) {
    init_ros(argc, argv, node_name(arguments.settings.name.value_or(std::string(source->map.name))));
    const auto all = with_parameters(arguments.settings);
    if (!all) return all.error();
    settings = *all;
  }
  apply(settings, source->map);
  return run(source->map, settings.verify.value_or(Verify::require));
}

}  // namespace coupler::driver
