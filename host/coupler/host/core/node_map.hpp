// SPDX-License-Identifier: Apache-2.0
// The identity and the map of a node of this project. Foreign couplers have neither.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "coupler/host/core/link.hpp"
#include "coupler/map/identity.hpp"
#include "coupler/map/loader/load.hpp"

namespace coupler::host {

/// load_served_map(), which is passed in so that the core needs no YAML.
using MapLoader = std::function<LoadResult(std::string_view text, std::string_view file)>;

/// Reads the head of the identity; nullopt for a foreign coupler, which answers with an exception or with
/// something else.
Result<std::optional<identity::Head>> read_identity(Link& link);

/// Reads all that a node of any age has in its identity area, without the statistics if they may not be read;
/// nullopt as above.
Result<std::optional<identity::Report>> read_report(Link& link);

/// Reads which machine the node runs on, with its hostname in printable ASCII, and what the node can do. Both
/// are empty if the node is older than these fields.
Result<identity::Further> read_further(Link& link);

/// Returns a text as "cell-7, serial 0123456789abcdef", as far as the machine is known.
std::string to_string(const identity::Machine& machine);

/// Reads the text of the map by FC 20, and does not check it.
Result<std::string> fetch_map_text(Link& link, std::uint32_t size);

/// The head of the identity and the text of the map, as the node has them.
struct ServedMap {
  identity::Head head;
  std::string text;
};

/// Reads both over a connection of its own, which is closed afterwards; nullopt for a foreign coupler.
Result<std::optional<ServedMap>> fetch_served_map(Link& link);

/// Loads a map from a text that was read. The error says what is wrong: its checksum, or errors in the map.
tl::expected<MapPtr, std::string> load_node_map(const std::string& text, const identity::Head& head,
                                                const MapLoader& load);

}  // namespace coupler::host
