// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ros/node_handle.h>

#include "host/ros/settings.hpp"

namespace coupler::driver {

/// The settings among the parameters of a namespace, of whichever type they were given. The error names the
/// parameter.
tl::expected<Settings, std::string> read_parameters(const ros::NodeHandle& handle);

}  // namespace coupler::driver
