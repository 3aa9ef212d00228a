// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include <tl/expected.hpp>

#include "coupler/tools/map_argument.hpp"

namespace coupler::tools {

/// Returns a map for a device of which only the place is known: the map that the device serves; otherwise one
/// with the preset of the coupler that its registers show; otherwise a draft of everything that a scan finds,
/// which may take minutes and ends at Ctrl-C with what was found by then. Says on standard error, as
/// `command`, which of them it is. Never writes to the device, and leaves no connection open. The exit status
/// of a failure is bad_call for a place that cannot be scanned, bad_input for a served map that does not
/// load, and otherwise failed, as for the network, or for a signal before there was a map.
tl::expected<FoundMap, Failure> map_of_unknown_device(std::string_view command, const Place& place);

}  // namespace coupler::tools
