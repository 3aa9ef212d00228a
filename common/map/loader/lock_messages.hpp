// SPDX-License-Identifier: Apache-2.0
// What is said of points and the lock of their map.
#pragma once

#include "common/map/loader/placement.hpp"

namespace coupler::loader {

/// The point has outgrown its place.
void tell_misfit(const DraftPoint& draft, const lock::Request& request, const lock::Entry& entry,
                 const Placement& placement, Context& context);

/// No place is left for the point.
void tell_full(const DraftPoint& draft, const lock::Request& request, Context& context);

/// Points without an address that `renewed` does not know.
void tell_unknown(const std::vector<const DraftPoint*>& points, const lock::Lock& renewed,
                  const Placement& placement, Context& context);

/// A warning for each point whose own address is that of a retired one.
void tell_reused(const DraftPoints& points, const lock::Lock& renewed, const Placement& placement,
                 Context& context);

/// The entry is not the file's.
void tell_stale(const lock::Entry& entry, Placement& placement);

}  // namespace coupler::loader
