// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "coupler/host/ros/dialect.hpp"
#include "coupler/host/ros/settings.hpp"

namespace coupler::host {

/// The arguments that are not ROS's own.
struct Options {
  Settings settings;
  std::optional<int> exit_code;  ///< the program is to end: 0 after --help, 2 after a wrong call
  std::string text;              ///< then: what to print, to stdout or stderr
};

/// `arguments`: `--key VALUE` or `--key=VALUE`, without the program.
Options parse_options(std::vector<std::string> arguments, const Dialect& dialect);

}  // namespace coupler::host
