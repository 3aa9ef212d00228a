// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "coupler/map/loader/areas.hpp"
#include "coupler/map/loader/context.hpp"
#include "coupler/map/loader/draft_point.hpp"
#include "coupler/map/loader/lock_file.hpp"
#include "coupler/map/loader/preset.hpp"
#include "coupler/map/lock/allocate.hpp"

namespace coupler::loader {

/// A map's lock while the map is read.
struct Placement {
  std::string map;  ///< path of the map
  LockFile file;
  lock::Lock known;        ///< what the file says
  NewLock renewed{};       ///< what it would have to say
  Diagnostics problems{};  ///< about the lock
};

/// What is closed to points without an address: the node's own registers, what the map keeps free or the
/// device refuses, what the preset has no modules for, and where the points with an address are.
lock::FreeSpace free_space_of(const DraftPoints& points, const Areas& reserved, const Areas& unreadable,
                              const std::optional<Preset>& preset);

/// Gives points without an address theirs: they are `placed` then.
void place_points(DraftPoints& points, const lock::FreeSpace& free_space, Placement& placement,
                  Context& context);

}  // namespace coupler::loader
