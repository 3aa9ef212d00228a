// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "coupler/map/loader/address.hpp"
#include "coupler/map/loader/draft_point.hpp"
#include "coupler/map/loader/load.hpp"
#include "coupler/map/loader/preset.hpp"
#include "coupler/map/loader/reader.hpp"
#include "coupler/map/lock/allocate.hpp"

namespace coupler::loader {

/// Addresses that the file says something about.
struct Area {
  Table table;
  modbus::Range range;
  Position at;
};
using Areas = std::vector<Area>;

/// A map's lock while the map is read.
struct Placement {
  std::string map;  ///< path of the map
  LockFile file;
  lock::Lock known;        ///< what the file says
  NewLock renewed{};       ///< what it would have to say
  Diagnostics problems{};  ///< about the lock
};

/// Returns the space for points without an address: all but the node's own registers, areas that the map
/// reserves or the device refuses, areas outside those of the preset, and the points with an address.
lock::FreeSpace free_space_of(const DraftPoints& points, const Areas& reserved, const Areas& unreadable,
                              const std::optional<Preset>& preset);

/// Gives points without an address theirs. They are `placed` then.
void place_points(DraftPoints& points, const lock::FreeSpace& free_space, Placement& placement,
                  const Context& context);

/// The text of a map as it is served: with the addresses that its points got from the lock, and with the
/// types' names of IEC 61131-3. The same map, for a reader without a lock and of any version. `text` itself
/// if it has both; the points must come from it.
std::string completed_text(std::string_view text, const DraftPoints& points, Addressing addressing);

}  // namespace coupler::loader
