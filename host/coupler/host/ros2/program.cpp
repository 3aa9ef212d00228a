// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/ros/program.hpp"

#include <exception>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "coupler/base/ending_signals.hpp"
#include "coupler/base/what_failed.hpp"
#include "coupler/host/ros/drive.hpp"
#include "coupler/host/ros/map_sources.hpp"
#include "coupler/host/ros/node_name.hpp"
#include "coupler/host/ros/shutdown.hpp"
#include "coupler/host/ros2/arguments.hpp"
#include "coupler/host/ros2/node.hpp"
#include "coupler/host/ros2/parameters.hpp"
#include "coupler/host/ros2/rcl/error.hpp"

namespace coupler::host {
namespace {

/// Thrown when the reason has been logged.
struct Exit {
  int exit_code;
};

bool have_same_maps(const Settings& one, const Settings& other) {
  return one.map == other.map && one.maps == other.maps && one.name == other.name &&
         one.address == other.address;
}

tl::expected<bool, std::string> wants_sim_time(const std::vector<GivenParameter>& parameters) {
  bool wanted = false;
  for (const GivenParameter& one : parameters) {
    if (one.name != "use_sim_time") continue;
    if (one.text != "true" && one.text != "false")  // in quotes, too, as a launch file may pass it
      return tl::make_unexpected(fmt::format("parameter use_sim_time: '{}' is not true or false", one.text));
    wanted = one.text == "true";
  }
  return wanted;
}

/// One driver, from its arguments to its end.
class Program {
 public:
  Program(const Map* built_in, Arguments arguments)
      : built_in_(built_in),
        arguments_(std::move(arguments)),
        context_(arguments_.for_ros),
        given_(GivenParameters::of(context_.arguments())) {}

  int run() {
    Ros2Node& node = node_.emplace(context_, choose_node_name());
    node.check_remappings(remappings_of(arguments_.for_ros, node.name()));
    const auto parameters = given_.for_node(node.full_name());
    node.declare_sim_time(value_or_fail(wants_sim_time(parameters)));
    const Settings settings = overlay(value_or_fail(settings_among(parameters, "")), arguments_.settings);
    declare_settings(node.parameters(), settings);
    if (!sources_ || !have_same_maps(settings, early_settings_)) find(settings);
    const bool several = sources_->size() > 1;
    const auto names = several ? names_of(*sources_) : std::vector<std::string_view>();
    for (const std::string& line : given_.unknown(node.full_name(), names)) log(Level::warning, line);
    const auto settings_of = [&](std::string_view name) -> tl::expected<Settings, std::string> {
      if (!several) return settings;
      return settings_among(parameters, fmt::format("{}.", name)).map([&](const Settings& own) {
        return overlay(settings, own);
      });
    };
    const Devices devices = value_or_fail(configure(std::move(*sources_), settings_of));
    declare_devices(node.parameters(), devices);
    return drive(devices, node);
  }

 private:
  /// On the terminal; once there is a node, on /rosout, too.
  void log(Level level, const std::string& text) { node_ ? node_->log(level, text) : print_message(text); }

  [[noreturn]] void fail(int exit_code, const std::string& why) {
    log(Level::error, why);
    throw Exit{exit_code};
  }

  template <class T>
  T value_or_fail(tl::expected<T, std::string> expected) {
    if (!expected) fail(wrong_input, expected.error());
    return std::move(*expected);
  }

  void find(const Settings& settings) {
    auto sources = find_maps(
        built_in_, settings, ros2_dialect, [this](Level level, const std::string& text) { log(level, text); },
        node_ ? &*node_ : nullptr);
    if (!sources) throw Exit{sources.error()};
    sources_ = std::move(*sources);
  }

  /// Before there is a node, and without asking a device: the node is in the graph while it waits for that.
  std::string choose_node_name() {
    if (arguments_.names_the_node) return "coupler_driver";
    early_settings_ = overlay(value_or_fail(settings_among(given_.for_node(""), "")), arguments_.settings);
    if (early_settings_.name && early_settings_.maps.empty()) return node_name(*early_settings_.name);
    if (is_map_of_a_node(built_in_, early_settings_)) return node_name_by_address(early_settings_);
    if (const auto section = given_.driver_section();
        !section.empty() && !early_settings_.map && early_settings_.maps.empty() && built_in_ == nullptr)
      fail(wrong_call,
           fmt::format("no map; to use the parameters of {}, name the node by --ros-args -r __node:={}",
                       section, section.substr(section.rfind('/') + 1)));
    find(early_settings_);
    return node_name(sources_->front().map.name);
  }

  const Map* built_in_;
  Arguments arguments_;
  rcl::Context context_;
  GivenParameters given_;
  std::optional<Ros2Node> node_;
  Settings early_settings_;  ///< before the node's own parameters are known; the sources may view them
  std::optional<std::vector<MapSource>> sources_;
};

}  // namespace

int main_with(const Map* built_in, int argc, char** argv) {
  begin_program();
  Arguments arguments = parse_arguments({argv, static_cast<std::size_t>(argc)});
  if (arguments.exit_code) return end_of(arguments);
  never_wait_for_readers();
  end_safely_on_uncaught_exceptions();
  Shutdown::request_on_signals();
  try {
    return end_with(Program(built_in, std::move(arguments)).run());
  } catch (const Exit& exit) {
    return exit.exit_code;
  } catch (const rcl::Error& error) {
    const bool is_wrong_call = error.result() == RCL_RET_INVALID_ROS_ARGS;
    const std::string_view remedy = is_wrong_call ? remedy_of(error.what()) : std::string_view();
    print_message(fmt::format("{}{}{}", error.what(), remedy.empty() ? "" : "; ", remedy));
    return is_wrong_call ? wrong_call : wrong_input;
  } catch (const std::exception& error) {  // no thread or no memory is left
    print_message(what_failed(error));
    return wrong_input;
  }
}

}  // namespace coupler::host
