// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "coupler/map/point.hpp"

namespace coupler::docs {

/// The message type of the point's topics, "std_msgs/Float32". The driver chooses by types
/// (coupler/host/ros/message.hpp); its tests hold the two together.
std::string ros_message(const Point& point);

}  // namespace coupler::docs
