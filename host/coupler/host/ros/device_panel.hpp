// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "coupler/host/core/value_table.hpp"
#include "coupler/host/ros/follower.hpp"
#include "coupler/map/map.hpp"

namespace coupler::host {

/// Serves a page with the live values of a driven device, for this machine only. The page cannot write. If
/// it cannot be served, the function reports why and returns null; the device is driven all the same. The
/// storage of `map` and the table must outlive the page.
std::unique_ptr<Follower> start_panel(const Map& map, const ValueTable& table, unsigned port,
                                      const std::function<void(Level, const std::string&)>& report);

}  // namespace coupler::host
