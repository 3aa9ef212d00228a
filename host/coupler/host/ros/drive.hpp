// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "coupler/host/ros/map_sources.hpp"
#include "coupler/host/ros/node.hpp"

namespace coupler::host {

/// Drives the devices until Shutdown::requested, the node's own end or a failure, which is logged; then makes
/// outputs safe and shuts the node down. Returns 0, not_safe, or wrong_input after a failure.
int drive(const Devices& devices, Node& node);

}  // namespace coupler::host
