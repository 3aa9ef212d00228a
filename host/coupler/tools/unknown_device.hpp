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

/// A map for a device of which nothing is known but its place, as node_argument() completes it: the one that
/// it serves, else one with the preset of a coupler that its registers tell, else a draft of all that a scan
/// finds, which may take minutes. Says on standard error, as `command`, which of them it is. Never writes to
/// the device, and leaves no connection behind. bad_call: no place; bad_input: its map does not load; failed:
/// the network, or Ctrl-C.
tl::expected<FoundMap, Failure> map_of_unknown_device(std::string_view command, const std::string& place,
                                                      const TlsTexts& tls);

}  // namespace coupler::tools
