// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <rmw/qos_profiles.h>

#include <cstddef>

namespace coupler::rcl {

/// Reliable, volatile, the last `depth`.
inline rmw_qos_profile_t reliable(std::size_t depth) {
  rmw_qos_profile_t qos = rmw_qos_profile_default;
  qos.depth = depth;
  return qos;
}

/// A late subscriber that asks for transient local gets the last one at once.
inline rmw_qos_profile_t latched() {
  rmw_qos_profile_t qos = reliable(1);
  qos.durability = RMW_QOS_POLICY_DURABILITY_TRANSIENT_LOCAL;
  return qos;
}

/// Of /clock.
inline rmw_qos_profile_t best_effort(std::size_t depth) {
  rmw_qos_profile_t qos = reliable(depth);
  qos.reliability = RMW_QOS_POLICY_RELIABILITY_BEST_EFFORT;
  return qos;
}

}  // namespace coupler::rcl
