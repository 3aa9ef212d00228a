// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "coupler/host/ros/configuration.hpp"
#include "coupler/host/ros/node.hpp"

namespace coupler::host {

/// Drives the devices until Shutdown::requested or the node's own end, then shuts the node down. Returns 0,
/// or not_safe.
int drive(const Devices& devices, Node& node);

}  // namespace coupler::host
