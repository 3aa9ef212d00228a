// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "coupler/host/core/transport.hpp"
#include "coupler/map/map.hpp"

namespace coupler::host {

/// The transports of `maps`, in their order. Several maps with the same address and port are units behind one
/// gateway: they share a connection, unless the `limits: connections` of all of them allow one each. Those on
/// one serial port, or with RTU over TCP to the same place, always share one.
std::vector<std::unique_ptr<Transport>> make_transports(const std::vector<Map>& maps);

/// Returns which of `maps` are on one line but have different settings of it, and what to do; empty if there
/// are none.
std::string line_conflict(const std::vector<Map>& maps);

}  // namespace coupler::host
