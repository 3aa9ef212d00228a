// SPDX-License-Identifier: Apache-2.0
#include "host/ros/arguments.hpp"

#include <sstream>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

namespace coupler::driver {
namespace {

constexpr const char* description =
    "Drives a Modbus/TCP coupler: every point of its map becomes a ROS topic <name>/<point>, every writable "
    "one also\n"
    "listens to <name>/<point>/write.";

constexpr const char* examples =
    "Each option is also a private parameter (~rate) and, as ROS has it, an argument (_rate:=20).\n"
    "Precedence: map < parameter < argument.\n\n"
    "Examples:\n"
    "  coupler_driver _map:=device.yaml\n"
    "  coupler_driver --map device.yaml --address 192.168.10.101 --rate 50\n"
    "  coupler_driver _address:=raspberrypi        (a node that serves its map)\n"
    "  coupler_driver _maps:=[press.yaml,belt.yaml]\n"
    "  rostopic echo /device/in_A\n"
    "  rostopic pub -1 /device/out_Z/write std_msgs/Bool true";

bool starts_with(std::string_view text, std::string_view with) { return text.substr(0, with.size()) == with; }

/// The arguments as CLI11 knows them, last first as it wants them; ROS's own are left out.
std::vector<std::string> in_one_spelling(Span<char* const> arguments, bool& names_the_node) {
  std::vector<std::string> result;
  for (const char* const raw : arguments.from(1)) {
    const std::string_view argument(raw);
    const std::size_t assign = argument.find(":=");
    if (assign == std::string_view::npos) {
      result.emplace_back(argument);
    } else if (argument[0] == '_' && !starts_with(argument, "__")) {
      result.push_back(fmt::format("--{}={}", argument.substr(1, assign - 1), argument.substr(assign + 2)));
    } else if (starts_with(argument, "__name:=")) {
      names_the_node = true;
    }
  }
  return {result.rbegin(), result.rend()};
}

std::string option_names(const SettingKey& key) {
  return key.alias.empty() ? fmt::format("--{}", key.key) : fmt::format("--{},--{}", key.key, key.alias);
}

}  // namespace

Arguments parse_arguments(Span<char* const> arguments) {
  Arguments result;
  CLI::App app(description, "coupler_driver");
  app.footer(examples);
  std::array<std::string, setting_keys.size()> texts;
  for (std::size_t i = 0; i < texts.size(); ++i)
    app.add_option(option_names(setting_keys[i]), texts[i], std::string(setting_keys[i].help));
  try {
    app.parse(in_one_spelling(arguments, result.names_the_node));
  } catch (const CLI::ParseError& error) {
    std::ostringstream out;
    std::ostringstream err;
    result.exit_code = app.exit(error, out, err) == 0 ? 0 : 2;
    result.text = out.str() + err.str();
    return result;
  }
  for (std::size_t i = 0; i < texts.size(); ++i) {
    const SettingKey& key = setting_keys[i];
    if (app.count("--" + std::string(key.key)) == 0) continue;
    if (const auto done = set(result.settings, key.key, texts[i]); !done) {
      result.exit_code = 2;
      result.text = done.error() + "\n";
    }
  }
  return result;
}

}  // namespace coupler::driver
