// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "coupler/host/ros/settings.hpp"

namespace coupler::host {

/// Texts that differ between ROS 1 and ROS 2. Where `--key VALUE`, which both understand, says it, none is
/// needed.
struct Dialect {
  std::string_view help;            ///< the last lines of --help
  std::string_view device_setting;  ///< how a setting of one device of several is given
  std::string_view relative_path;   ///< the remedy for a relative path that was not found; has {path}
  std::string_view left_out;        ///< for --version: " without PACKAGE", if it was not there at the build
};

/// The arguments that are not ROS's own.
struct Options {
  Settings settings;
  std::optional<int> exit_code;  ///< the program is to end: 0 after --help, 2 after a wrong call
  std::string text;              ///< then: what to print, to stdout or stderr
};

/// `arguments`: `--key VALUE` or `--key=VALUE`, without the program.
Options parse_options(std::vector<std::string> arguments, const Dialect& dialect);

}  // namespace coupler::host
