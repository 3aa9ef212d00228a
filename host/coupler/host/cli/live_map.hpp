// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <tl/expected.hpp>

#include "coupler/cli/live_device.hpp"

namespace coupler::cli {

/// Does what fetch_live_map() does. Returns nullptr for a foreign coupler, also for one that is there and
/// does not answer such a question.
tl::expected<MapPtr, NoLiveMap> fetch_map_if_node(const Connection& where);

}  // namespace coupler::cli
