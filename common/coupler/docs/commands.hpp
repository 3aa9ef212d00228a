// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "coupler/map/map.hpp"

namespace coupler::docs {

/// A line for a shell, and what it does.
struct Command {
  std::string what;
  std::string line;
};

/// mbpoll reads the first point of each address space as what it is; a value that mbpoll has no type for it
/// shows as its registers.
std::vector<Command> mbpoll_commands(const Map& map);

/// The driver makes the topics; the tools of ROS 2 and of ROS 1 show the first readable point and write the
/// first writable one.
std::vector<Command> ros_commands(const Map& map, const std::string& file);

}  // namespace coupler::docs
