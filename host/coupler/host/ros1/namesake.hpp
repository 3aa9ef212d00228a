// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

namespace coupler::host {

/// The master ends a node when another one registers its name. Two that are started again whenever they end
/// would end each other for ever, and their outputs would change each time.
///
/// Between ros::init() and ros::start(), which registers the name. Waits for a master. Returns the error if a
/// node of this one's name is there and answers. One that was killed does not, though the master knows it.
std::optional<std::string> namesake_error();

/// Before ros::start(): says why a node has to end, when another one tells it to.
void tell_why_ros_ends();

}  // namespace coupler::host
