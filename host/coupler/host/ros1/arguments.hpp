// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <vector>

#include "coupler/base/span.hpp"
#include "coupler/host/ros/options.hpp"

namespace coupler::host {

extern const Dialect ros1_dialect;
extern const Dialect roslaunch_dialect;  ///< of a program that roslaunch started

struct Arguments : Options {
  std::map<std::string, Settings> of_devices;  ///< by the name in their maps
  std::vector<char*> for_ros;   ///< all but those of one device: ROS would keep them as parameters
  bool names_the_node = false;  ///< `__name:=` is there
  bool by_roslaunch = false;    ///< so is `__log:=`, which nobody else gives
};

/// Reads the settings in both spellings, `_key:=VALUE` and `--key VALUE`, and those of one device of several,
/// `_NAME/key:=VALUE`. Skips ROS's own arguments (`from:=to`, `__name:=…`). `arguments[0]` is the program.
Arguments parse_arguments(Span<char* const> arguments);

}  // namespace coupler::host
