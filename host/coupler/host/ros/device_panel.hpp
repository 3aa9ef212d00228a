// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "coupler/host/core/value_table.hpp"
#include "coupler/host/ros/follower.hpp"
#include "coupler/map/map.hpp"

namespace coupler::host {

/// Serves the live page of a device that is driven, on this machine; it only shows. Null, after it is
/// reported, if it cannot be served: the device is driven all the same. What `map`
/// views, and the table, must outlive it.
std::unique_ptr<Follower> start_panel(const Map& map, const ValueTable& table, unsigned port,
                                      const std::function<void(Level, const std::string&)>& report);

}  // namespace coupler::host
