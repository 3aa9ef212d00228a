// SPDX-License-Identifier: Apache-2.0
// What a node of this project says about itself: its identity and its map. Foreign couplers have neither.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "coupler/host/core/transport.hpp"
#include "coupler/map/identity.hpp"
#include "coupler/map/loader/load.hpp"

namespace coupler::host {

/// load_served_map(), passed in so that the core needs no YAML.
using MapLoader = std::function<LoadResult(std::string_view text, std::string_view file)>;

/// nullopt: a foreign coupler, which answers with an exception or with something else.
Result<std::optional<identity::Head>> read_identity(Transport& transport);

/// All that a node of any age has in its identity area, or without the statistics, if they may not be read;
/// nullopt as above.
Result<std::optional<identity::Report>> read_report(Transport& transport);

/// Which machine a node runs on, hostname in printable ASCII, and what it can do. Empty: the node is older
/// than these fields.
Result<identity::Further> read_further(Transport& transport);

/// "cell-7, serial 0123456789abcdef", as far as it is known.
std::string to_string(const identity::Machine& machine);

/// The text of the map by FC 20, unchecked.
Result<std::string> fetch_map_text(Transport& transport, std::uint32_t size);

/// The head and the map's text as the node has them.
struct ServedMap {
  identity::Head head;
  std::string text;
};

/// Both, over a connection of its own, which is closed then; nullopt: a foreign coupler.
Result<std::optional<ServedMap>> fetch_served_map(Transport& transport);

/// The map in a text that was fetched, or what is wrong with it: its checksum, errors.
tl::expected<MapPtr, std::string> load_node_map(const std::string& text, const identity::Head& head,
                                                const MapLoader& load);

}  // namespace coupler::host
