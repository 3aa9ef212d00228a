// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ros/node_handle.h>

#include "coupler/host/ros/settings.hpp"

namespace coupler::host {

/// The settings among the parameters of a namespace, of whichever type they were given. The error names the
/// parameter.
tl::expected<Settings, std::string> read_parameters(const ros::NodeHandle& handle);

/// A line for each parameter of this node that is not a setting: misspelt ones do nothing. `devices`: the
/// names of several, whose settings stand below them.
std::vector<std::string> unknown_parameters(const std::vector<std::string_view>& devices);

}  // namespace coupler::host
