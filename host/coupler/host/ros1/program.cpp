// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/ros/program.hpp"

#include <XmlRpcException.h>
#include <ros/console.h>
#include <ros/exceptions.h>
#include <ros/init.h>
#include <ros/param.h>
#include <ros/this_node.h>

#include <algorithm>
#include <array>
#include <exception>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "coupler/base/ending_signals.hpp"
#include "coupler/base/what_failed.hpp"
#include "coupler/host/ros/drive.hpp"
#include "coupler/host/ros/map_sources.hpp"
#include "coupler/host/ros/node_name.hpp"
#include "coupler/host/ros/shutdown.hpp"
#include "coupler/host/ros1/arguments.hpp"
#include "coupler/host/ros1/namesake.hpp"
#include "coupler/host/ros1/node.hpp"
#include "coupler/map/printable.hpp"

namespace coupler::host {
namespace {

/// The name is overridden by `__name`. Without a master it waits for one, and a signal exits; afterwards the
/// first one is left to ROS, as long as the driver has not its own handler. Otherwise, after printing why,
/// the exit code: ROS does not accept the name, or another node has it.
std::optional<int> init_ros(std::vector<char*> argv, const std::string& name) {
  int argc = static_cast<int>(argv.size());
  try {
    // ROS's own handler only notes that it is to end, and nobody looks at that while there is no master.
    ros::init(argc, argv.data(), name, ros::init_options::NoSigintHandler);
  } catch (const ros::InvalidNameException& error) {
    print_message(fmt::format("{}; an argument for one device begins with '_', as in _press/address:=HOST",
                              error.what()));
    return wrong_call;
  }
  if (const auto error = namesake_error()) {
    print_message(*error);
    return wrong_input;
  }
  tell_why_ros_ends();
  ros::start();  // here, or else the end of the first NodeHandle ends ROS
  Shutdown::unregister_on_signals(ros::requestShutdown);
  return std::nullopt;
}

std::optional<std::string> text_of(XmlRpc::XmlRpcValue& value);

/// The elements, separated by commas.
std::optional<std::string> list_of(XmlRpc::XmlRpcValue& value) {
  std::string list;
  for (int i = 0; i < value.size(); ++i) {
    const auto text = text_of(value[i]);
    if (!text) return std::nullopt;
    list += (i > 0 ? "," : "") + *text;
  }
  return list;
}

std::optional<std::string> text_of(XmlRpc::XmlRpcValue& value) {
  switch (value.getType()) {
    case XmlRpc::XmlRpcValue::TypeBoolean: return static_cast<bool>(value) ? "true" : "false";
    case XmlRpc::XmlRpcValue::TypeInt: return fmt::to_string(static_cast<int>(value));
    case XmlRpc::XmlRpcValue::TypeDouble: return fmt::to_string(static_cast<double>(value));
    case XmlRpc::XmlRpcValue::TypeString: return static_cast<std::string>(value);
    case XmlRpc::XmlRpcValue::TypeArray: return list_of(value);
    default: return std::nullopt;
  }
}

/// The settings among the parameters of a namespace, of whichever type they were given. The error names the
/// parameter.
tl::expected<Settings, std::string> read_parameters(const ros::NodeHandle& handle) {
  const auto text = [&](const SettingKey& /*key*/, const std::string& name) -> ParameterText {
    XmlRpc::XmlRpcValue value;
    if (!handle.getParam(name, value)) return std::nullopt;
    auto given = text_of(value);
    if (!given) return tl::make_unexpected("a value or a list is needed");
    return given;
  };
  return settings_among(handle.getNamespace() + "/", text);
}

/// Parameters of diagnostic_updater.
constexpr std::array<std::string_view, 2> other_parameters{"diagnostic_period", "diagnostic_updater_fast"};

/// Warns of each parameter in the tree that is not a setting: misspelt ones do nothing. `devices`: the names
/// of several, whose settings stand below them.
void warn_of_unknown(XmlRpc::XmlRpcValue& tree, const std::string& place,
                     const std::vector<std::string_view>& devices) {
  if (tree.getType() != XmlRpc::XmlRpcValue::TypeStruct) return;
  for (auto& [name, value] : tree) {
    const std::string parameter = fmt::format("{}/{}", place, name);
    if (std::find(other_parameters.begin(), other_parameters.end(), name) != other_parameters.end()) continue;
    if (std::find(devices.begin(), devices.end(), name) != devices.end())
      warn_of_unknown(value, parameter, {});
    else if (!is_setting(name))
      ROS_WARN("%s", printable_lines(unknown_parameter(parameter, name)).c_str());
  }
}

/// A line for each name that arguments are given for and no map has.
std::string unknown_devices(const std::vector<MapSource>& sources, const Arguments& arguments) {
  const std::vector<std::string_view> names = names_of(sources);
  std::string text;
  for (const auto& [name, settings] : arguments.of_devices)
    if (std::find(names.begin(), names.end(), name) == names.end())
      text += fmt::format("{}there are arguments for the device '{}', but the maps have the names {}",
                          text.empty() ? "" : "\ncoupler_driver: ", name, fmt::join(names, ", "));
  return text;
}

/// Precedence: map < parameter ~key < argument < parameter ~NAME/key, where there are several devices <
/// argument for the device. The error is the exit code.
tl::expected<Devices, int> configure_all(std::vector<MapSource> sources, const Arguments& arguments) {
  if (const std::string wrong = unknown_devices(sources, arguments); !wrong.empty()) {
    print_message(wrong);
    return tl::make_unexpected(wrong_call);
  }
  const bool several = sources.size() > 1;
  const std::string& node = ros::this_node::getName();
  if (XmlRpc::XmlRpcValue tree; ros::param::get(node, tree))
    warn_of_unknown(tree, node, several ? names_of(sources) : std::vector<std::string_view>());
  const auto common = read_parameters(ros::NodeHandle("~"));
  const auto settings_of = [&](std::string_view name) -> tl::expected<Settings, std::string> {
    if (!common) return tl::make_unexpected(common.error());
    Settings settings = overlay(*common, arguments.settings);
    if (several) {
      const auto own = read_parameters(ros::NodeHandle("~" + std::string(name)));
      if (!own) return own;
      settings = overlay(settings, *own);
    }
    const auto own = arguments.of_devices.find(std::string(name));
    if (own != arguments.of_devices.end()) settings = overlay(settings, own->second);
    return settings;
  };
  auto devices = configure(std::move(sources), settings_of);
  if (devices) return std::move(*devices);
  print_message(devices.error());
  return tl::make_unexpected(wrong_input);
}

/// One driver, from its arguments to its end.
int run(const Map* built_in, const Arguments& arguments) {
  Settings settings = arguments.settings;
  // A node that was given its name (by roslaunch, say) may have its map in its parameters. Otherwise the map
  // gives the name, and the parameters are those of that name.
  std::optional<Ros1Node> node;
  if (arguments.names_the_node) {
    if (const auto code = init_ros(arguments.for_ros, "coupler_driver")) return *code;
    const auto parameters = read_parameters(ros::NodeHandle("~"));
    if (!parameters) {
      print_message(parameters.error());
      return wrong_input;
    }
    settings = overlay(*parameters, arguments.settings);
    Shutdown::request_on_signals();
    node.emplace();  // its diagnostics say that a map is waited for
  }
  const auto print = [](Level /*level*/, const std::string& text) { print_message(text); };
  auto sources = find_maps(built_in, settings, arguments.by_roslaunch ? roslaunch_dialect : ros1_dialect,
                           print, node ? &*node : nullptr);
  if (!sources) return sources.error();
  const std::string name =
      node_name(arguments.settings.name.value_or(std::string(sources->front().map.name)));
  if (!arguments.names_the_node)
    if (const auto code = init_ros(arguments.for_ros, name)) return *code;
  const auto devices = configure_all(std::move(*sources), arguments);
  if (!devices) return devices.error();
  // roscpp would shut down in a thread of its own, while this one still uses it.
  Shutdown::request_on_signals();
  if (!node) node.emplace();
  return drive(*devices, *node);
}

}  // namespace

int main_with(const Map* built_in, int argc, char** argv) {
  begin_program();
  const Arguments arguments = parse_arguments({argv, static_cast<std::size_t>(argc)});
  if (arguments.exit_code) return end_of(arguments);
  never_wait_for_readers();
  end_safely_on_uncaught_exceptions();
  try {
    return end_with(run(built_in, arguments));
  } catch (const std::exception& error) {  // no thread or no memory is left
    print_message(what_failed(error));
  } catch (const XmlRpc::XmlRpcException& error) {  // the master's answer is none
    print_message(error.getMessage());
  }
  return wrong_input;
}

}  // namespace coupler::host
