// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "coupler/host/core/link.hpp"
#include "coupler/map/map.hpp"

namespace coupler::host {

/// Makes a link with a channel of its own, by Modbus/TCP or RTU as `connection` says.
Link make_link(const Connection& connection, const Limits& limits = {});

/// Makes the links of `maps`, in their order. Several maps with the same address and port are units behind
/// one gateway: they share a channel, unless the `limits: connections` of all of them allow one each. Those
/// on one serial port, or with RTU over TCP to the same place, always share one.
std::vector<std::unique_ptr<Link>> make_links(const std::vector<Map>& maps);

/// Returns a message about two of `maps` that share a line or an address but differ in its settings, and what
/// to do; empty if there are no such maps.
std::string line_conflict(const std::vector<Map>& maps);

}  // namespace coupler::host
