// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <tl/expected.hpp>

#include "coupler/device/analogue/sysfs_channels.hpp"
#include "coupler/map/map.hpp"

namespace coupler::device {

/// The channels behind the map's registers, with outputs as they are; null if it has none. The error says of
/// each channel that cannot be had what is there instead, and the remedy; it may have several lines. `map`
/// and `log` outlive the result.
tl::expected<std::unique_ptr<SysfsChannels>, std::string> open_channels(const Map& map, Log& log,
                                                                        const std::string& sysfs = "/sys");

}  // namespace coupler::device
