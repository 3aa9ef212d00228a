// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "coupler/host/ros/configuration.hpp"
#include "coupler/host/ros/node.hpp"

namespace coupler::host {

/// Drives them until Ending::asked or the end of the node, then ends the node. Returns 0, or not_safe if an
/// output should have its safe value at the end and has not.
int drive(const Devices& devices, Node& node);

}  // namespace coupler::host
