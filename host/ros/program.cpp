// SPDX-License-Identifier: Apache-2.0
#include "host/ros/program.hpp"

#include <ros/exceptions.h>
#include <ros/init.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <deque>
#include <future>
#include <memory>
#include <optional>
#include <set>
#include <thread>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "common/base/standard_files.hpp"
#include "host/modbus/make_transports.hpp"
#include "host/ros/arguments.hpp"
#include "host/ros/device_topics.hpp"
#include "host/ros/logger_service.hpp"
#include "host/ros/map_source.hpp"
#include "host/ros/master_watch.hpp"
#include "host/ros/ros_log.hpp"
#include "host/ros/ros_parameters.hpp"

namespace coupler::driver {
namespace {

constexpr int wrong_input = 1;
constexpr int wrong_call = 2;
constexpr int not_safe = 3;
constexpr auto report_interval = std::chrono::milliseconds(100);
constexpr auto diagnostics_interval = std::chrono::seconds(1);

/// Until ROS is there nothing has been started that would have to be ended.
void end_at_once_on_signals() {
  const auto end = [](int) { ::_exit(0); };
  std::signal(SIGINT, end);
  std::signal(SIGTERM, end);
}

std::atomic<bool> is_ending{false};
std::atomic<bool> is_running{false};

/// roscpp would shut down in a thread of its own, while this one still uses it. The second signal is for one
/// who waits for a master that went away at the start; nothing has been driven then.
void end_in_order_on_signals() {
  const auto end = [](int) {
    if (is_ending.exchange(true) && !is_running) ::_exit(0);
  };
  std::signal(SIGINT, end);
  std::signal(SIGTERM, end);
}

/// `<name>_driver`: two drivers must not have one name, or the master shuts the first down.
std::string node_name(std::string_view map_name) {
  std::string name = fmt::format("{}_driver", map_name);
  std::replace(name.begin(), name.end(), '/', '_');
  return name;
}

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

tl::expected<Settings, int> parameters_of(const ros::NodeHandle& handle) {
  auto parameters = read_parameters(handle);
  if (parameters) return std::move(*parameters);
  print(parameters.error());
  return tl::make_unexpected(wrong_input);
}

/// A device as it is to be driven. The map refers to the settings' texts.
struct Configured {
  Settings settings;
  MapSource source;
};
using Devices = std::deque<Configured>;  // each stays where it is

std::vector<std::string_view> names_of(const std::vector<MapSource>& sources) {
  std::vector<std::string_view> names;
  names.reserve(sources.size());
  for (const MapSource& source : sources) names.push_back(source.map.name);
  return names;
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
/// argument for the device.
tl::expected<Devices, int> configure(std::vector<MapSource> sources, const Arguments& arguments) {
  if (const std::string wrong = strangers(sources, arguments); !wrong.empty()) {
    print(wrong);
    return tl::make_unexpected(wrong_call);
  }
  const bool several = sources.size() > 1;
  for (const std::string& line :
       unknown_parameters(several ? names_of(sources) : std::vector<std::string_view>()))
    log(Level::warning, line);
  const auto common = parameters_of(ros::NodeHandle("~"));
  if (!common) return tl::make_unexpected(common.error());
  Devices devices;
  for (MapSource& source : sources) {
    Settings settings = *common;
    if (several) {
      const auto own = parameters_of(ros::NodeHandle("~" + std::string(source.map.name)));
      if (!own) return tl::make_unexpected(own.error());
      settings = overlay(settings, *own);
    }
    settings = overlay(settings, arguments.settings);
    const auto own = arguments.of_devices.find(std::string(source.map.name));
    if (own != arguments.of_devices.end()) settings = overlay(settings, own->second);
    Configured& device = devices.emplace_back(Configured{std::move(settings), std::move(source)});
    apply(device.settings, device.source.map);
  }
  return devices;
}

/// What hinders them, or an empty text.
std::string why_not(const Devices& devices) {
  std::set<std::string_view> names;
  for (const auto& [settings, source] : devices) {
    if (source.map.connection.address.empty())
      return fmt::format("the map has no address; add 'address: HOST' or give _address:=HOST{}",
                         devices.size() > 1 ? fmt::format(" (map of {})", source.map.name) : "");
    if (!names.insert(source.map.name).second)
      return fmt::format(
          "two devices have the name {}; give one of them another, as in _maps:=[left=a.yaml,right=a.yaml]",
          source.map.name);
  }
  return {};
}

/// All at once: each may take most of a second for its safe values. Whether all have them that should.
bool end_all(const std::vector<std::unique_ptr<DeviceTopics>>& devices) {
  std::vector<std::future<bool>> ends;
  ends.reserve(devices.size());
  for (const auto& device : devices)
    ends.push_back(std::async(std::launch::async, [&device] { return device->end(); }));
  bool safe = true;
  for (auto& end : ends) safe &= end.get();
  return safe;
}

int run(const Devices& devices) {
  if (const std::string wrong = why_not(devices); !wrong.empty()) {
    print(wrong);
    return wrong_input;
  }
  end_in_order_on_signals();
  ros::NodeHandle handle;
  const ros::ServiceServer loggers = advertise_loggers();
  diagnostic_updater::Updater diagnostics;
  diagnostics.setHardwareID("coupler_driver");  // each device has its own
  std::vector<std::unique_ptr<DeviceTopics>> topics;
  std::vector<Map> maps;
  for (const auto& [settings, source] : devices) maps.push_back(source.map);
  auto transports = make_transports(maps);
  auto transport = transports.begin();
  for (const auto& [settings, source] : devices) {
    if (is_ending) break;
    topics.push_back(std::make_unique<DeviceTopics>(handle, diagnostics, source.map, std::move(*transport++),
                                                    settings.verify.value_or(Verify::require),
                                                    source.map.poll));
  }
  is_running = true;
  std::optional<MasterWatch> master;
  if (!is_ending) master.emplace();
  for (Time diagnosed = Time::min(); ros::ok() && !is_ending; std::this_thread::sleep_for(report_interval)) {
    const Time now = std::chrono::steady_clock::now();
    bool due = diagnosed == Time::min() || now - diagnosed >= diagnostics_interval;
    for (const auto& device : topics) due |= device->report(now);
    if (!due) continue;
    diagnosed = now;
    diagnostics.force_update();
  }
  const bool safe = end_all(topics);  // first: a master that is away may hold up what follows
  master.reset();
  ros::shutdown();
  return safe ? 0 : not_safe;
}

}  // namespace

int main_with(const Map* built_in, int argc, char** argv) {
  open_standard_files();
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
    if (!init_ros(arguments.for_ros, "coupler_driver")) return wrong_call;
    const auto parameters = parameters_of(ros::NodeHandle("~"));
    if (!parameters) return parameters.error();
    settings = overlay(*parameters, arguments.settings);
  }
  auto sources = find_maps(built_in, settings);
  if (!sources) return sources.error();
  const std::string name =
      node_name(arguments.settings.name.value_or(std::string(sources->front().map.name)));
  if (!arguments.names_the_node && !init_ros(arguments.for_ros, name)) return wrong_call;
  const auto devices = configure(std::move(*sources), arguments);
  return devices ? run(*devices) : devices.error();
}

}  // namespace coupler::driver
