// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "coupler/host/core/transport.hpp"
#include "coupler/map/map.hpp"

namespace coupler::host {

/// The transports of `maps`, in their order. Several maps with the same address and port are units behind one
/// gateway: they share a connection, unless the `limits: connections` of all of them allow one each.
std::vector<std::unique_ptr<Transport>> make_transports(const std::vector<Map>& maps);

}  // namespace coupler::host
