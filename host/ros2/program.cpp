// SPDX-License-Identifier: Apache-2.0
#include "host/ros/program.hpp"

#include <cstdio>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "common/base/standard_files.hpp"
#include "host/ros/configuration.hpp"
#include "host/ros/drive.hpp"
#include "host/ros/ending.hpp"
#include "host/ros2/arguments.hpp"
#include "host/ros2/given_parameters.hpp"
#include "host/ros2/node.hpp"
#include "host/ros2/shown_settings.hpp"

namespace coupler::driver {
namespace {

/// The call is wrong, or what it names; the text has been told.
struct Wrong {
  int exit_code;
};

[[noreturn]] void refuse(int exit_code, const std::string& why) {
  print(why);
  throw Wrong{exit_code};
}

template <class T>
T accept(tl::expected<T, std::string> expected) {
  if (!expected) refuse(wrong_input, expected.error());
  return std::move(*expected);
}

bool is_same_place(const Settings& one, const Settings& other) {
  return one.map == other.map && one.maps == other.maps && one.name == other.name &&
         one.address == other.address;
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
    if (const auto unknown = context_.unknown_arguments(); !unknown.empty())
      refuse(wrong_call,
             fmt::format("{}: nothing that ROS 2 knows behind --ros-args; options of the driver stand "
                         "before it",
                         unknown.front()));
    const std::string name = settle_name();
    Ros2Node node(context_, name, wants_sim_time(name));
    const auto parameters = given_.for_node(node.full_name());
    const Settings settings = overlay(accept(settings_among(parameters, "")), arguments_.settings);
    show_settings(node.parameters(), settings);
    if (!sources_ || !is_same_place(settings, early_))
      find(settings, [&](const std::string& text) { node.log(Level::error, text); });
    return drive_devices(node, parameters, settings);
  }

 private:
  void find(const Settings& settings, const Say& say) {
    auto sources = find_maps(built_in_, settings, ros2_dialect, say);
    if (!sources) throw Wrong{sources.error()};
    sources_ = std::move(*sources);
  }

  /// Before there is a node, and without asking a device: the node waits for that in the graph.
  std::string settle_name() {
    std::string name = "coupler_driver";
    if (arguments_.names_the_node) return name;
    early_ = overlay(accept(settings_among(given_.for_node(""), "")), arguments_.settings);
    if (early_.name && early_.maps.empty()) return node_name(*early_.name);
    if (is_map_of_a_node(built_in_, early_)) return node_name_by_address(early_);
    find(early_, print);
    return node_name(sources_->front().map.name);
  }

  bool wants_sim_time(const std::string& name) const {
    bool wanted = false;
    for (const GivenParameter& one : given_.for_node("/" + name))
      if (one.name == "use_sim_time") wanted = one.text == "true";
    return wanted;
  }

  int drive_devices(Ros2Node& node, const std::vector<GivenParameter>& parameters, const Settings& settings) {
    const bool several = sources_->size() > 1;
    const auto names = several ? names_of(*sources_) : std::vector<std::string_view>();
    for (const std::string& line : given_.unknown(node.full_name(), names)) node.log(Level::warning, line);
    const auto settings_of = [&](std::string_view name) -> tl::expected<Settings, std::string> {
      if (!several) return settings;
      const auto own = settings_among(parameters, fmt::format("{}.", name));
      if (!own) return own;
      Settings all = settings;
      return overlay(std::move(all), *own);
    };
    const Devices devices = accept(configure(std::move(*sources_), settings_of));
    if (const std::string wrong = why_not(devices); !wrong.empty()) refuse(wrong_input, wrong);
    show_devices(node.parameters(), devices);
    return drive(devices, node);
  }

  const Map* built_in_;
  Arguments arguments_;
  rcl::Context context_;
  GivenParameters given_;
  Settings early_;  ///< before the node's own parameters are known; what is found may view them
  std::optional<std::vector<MapSource>> sources_;
};

}  // namespace

int main_with(const Map* built_in, int argc, char** argv) {
  open_standard_files();
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  Ending::at_once_on_signals();
  Arguments arguments = parse_arguments({argv, static_cast<std::size_t>(argc)});
  if (arguments.exit_code) {
    fmt::print(*arguments.exit_code == 0 ? stdout : stderr, "{}", arguments.text);
    return *arguments.exit_code;
  }
  Ending::in_order_on_signals();
  try {
    return Program(built_in, std::move(arguments)).run();
  } catch (const Wrong& wrong) {
    return wrong.exit_code;
  } catch (const rcl::Error& error) {
    print(error.what());
    return wrong_input;
  }
}

}  // namespace coupler::driver
