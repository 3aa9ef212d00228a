// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/ros/options.hpp"

#include <utility>

#include <fmt/format.h>

#include "coupler/base/version.hpp"
#include "coupler/command_line/command_line.hpp"
#include "coupler/map/nearest.hpp"

namespace coupler::host {
namespace {

constexpr const char* description =
    "Drives a Modbus device, such as an I/O coupler or a PLC, over TCP or on a serial line: every point of "
    "its map becomes a ROS topic "
    "<name>/<point>, every writable "
    "one also\n"
    "listens to <name>/<point>/write.";

std::string option_names(const SettingKey& key) {
  return key.alias.empty() ? fmt::format("--{}", key.key) : fmt::format("--{},--{}", key.key, key.alias);
}

}  // namespace

Options parse_options(std::vector<std::string> arguments, const Dialect& dialect) {
  Options result;
  command_line::Program app(description, "coupler_driver");
  app.version(fmt::format("coupler_driver {}{}", version, dialect.left_out));
  app.propose(nearest);
  app.stray_is_of("--map", "--maps");
  app.footer(std::string(dialect.help));
  const std::vector<SettingKey>& keys = setting_keys();
  std::vector<std::string> texts(keys.size());
  std::vector<command_line::Option> options;
  options.reserve(texts.size());
  for (std::size_t i = 0; i < texts.size(); ++i)
    options.push_back(app.add_option(option_names(keys[i]), texts[i], std::string(keys[i].help)));
  result.exit_code = app.parse(std::move(arguments), result.text);
  if (result.exit_code) return result;
  for (std::size_t i = 0; i < texts.size(); ++i) {
    if (!options[i].given()) continue;
    if (const auto done = keys[i].set(result.settings, texts[i]); !done) {
      result.exit_code = 2;
      result.text += done.error() + "\n";
    }
  }
  return result;
}

}  // namespace coupler::host
