// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "coupler/map/loader/address.hpp"
#include "coupler/map/loader/draft_point.hpp"
#include "coupler/map/loader/joints.hpp"
#include "coupler/map/loader/placement.hpp"
#include "coupler/map/loader/preset.hpp"
#include "coupler/map/loader/reader.hpp"
#include "coupler/map/map.hpp"
#include "coupler/map/watchdog.hpp"

namespace coupler::loader {

// The keys at the top of a map.

/// The areas below `key`, in the order of the file.
Areas read_areas(const Reader& top, std::string_view key, Addressing addressing, const Context& context);

/// Returns the areas as the model has them, sorted by table and address.
std::vector<TableRange> by_place(const Areas& areas);

/// Reads what the top of the file says about the coupler, and not about its points. `usual_line` is `serial:`
/// of the map's preset, without a device, or nullptr. `port_without_tls` gets `port`, where a node with this
/// map listens; that of the result may be the one for TLS.
Connection read_connection(const Reader& top, const Entry* usual_line, std::uint16_t& port_without_tls,
                           const Context& context);
Polling read_polling(const Reader& top);
Limits read_limits(const Reader& top);

/// Reads what the top of the file says about a node that serves the map.
Service read_service(const Reader& top, const Context& context);

/// The value of a key that names a file of certificates or keys. Nothing is a problem, since it would mean no
/// TLS; so is PEM text in its place: a node serves its map to clients, and a map is in repositories.
void check_pem_path(const Reader& section, std::string_view key, const Context& context);

/// `security:`. The rights are in the order of the finished map.
/// `plain_port`: where clients without TLS connect.
Security read_security(const Reader& top, const DraftPoints& points, std::uint16_t plain_port,
                       const Context& context);

/// `sim:`, the wires of the simulated chip: each from a coil, or with a square wave, to a discrete input of
/// its own.
std::vector<SimWire> read_sim(const Reader& top, const DraftPoints& points, const Context& context);

/// `tools:`, in the order of the file. Their names are parts of ROS names; each has outputs of its own, and a
/// sensor or a time for each of its ends, and is a joint of its own.
std::vector<Tool> read_tools(const Reader& top, const DraftPoints& points, const Map& head, Joints& joints,
                             const Context& context);

/// `axes:`, in the order of the file. Each has a point of its own that no tool drives, and is a joint of its
/// own.
std::vector<Axis> read_axes(const Reader& top, const DraftPoints& points, const Map& head,
                            const std::vector<Tool>& tools, Joints& joints, const Context& context);

/// `watchdog:` of a map with `preset`: there it is the coupler's own, and leaves `head.service`. Without a
/// preset it is the node's, and stays.
void read_coupler_watchdog(const Reader& top, const std::optional<Preset>& preset, const DraftPoints& points,
                           Addressing addressing, Map& head, const Context& context);

/// The origin of a map.
struct MapSource {
  std::string_view text;      ///< of the file
  std::string_view name{};    ///< of a map that gives none; empty: it has to
  bool served = false;        ///< by a node, which may be newer than this program
  std::string_view folder{};  ///< of the file
};

/// The places of the finished map in its file.
struct MapLayout {
  std::vector<int> point_lines;  ///< LoadResult::point_lines
  Position first_addressless;    ///< the first point whose address the file leaves out
};

/// Reads the whole map and finishes `map`; nullopt if there are errors. Points without an address get theirs
/// from `placement`.
std::optional<MapLayout> read_map(const Entry& file, const MapSource& source, Placement& placement,
                                  Problems& problems, OwnedMap& map);

}  // namespace coupler::loader
