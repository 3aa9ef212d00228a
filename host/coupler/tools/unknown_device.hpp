// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include <tl/expected.hpp>

#include "coupler/map/owned_map.hpp"
#include "coupler/map/tls_texts.hpp"
#include "coupler/tools/commands.hpp"

namespace coupler::tools {

struct FoundMap {
  MapPtr map;
  Connection where;  ///< where the device has answered, without TLS; a view of the place or of the map
};

/// Returns a map for a device of which only the place is known, as node_argument() completes it: the map that
/// the device serves; otherwise one with the preset of the coupler that its registers show; otherwise a draft
/// of everything that a scan finds, which may take minutes and ends at Ctrl-C with what was found by then.
/// Says on standard error, as `command`, which of them it is. Never writes to the device, and leaves no
/// connection open. The exit status of a failure is bad_call for a wrong place or wrong TLS options,
/// bad_input for a served map that does not load, and otherwise failed, as for the network, or for a signal
/// before there was a map.
tl::expected<FoundMap, Failure> map_of_unknown_device(std::string_view command, const std::string& place,
                                                      const TlsTexts& tls);

}  // namespace coupler::tools
