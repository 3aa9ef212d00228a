// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "coupler/host/core/node_map.hpp"
#include "coupler/map/diff.hpp"

namespace coupler::host {

/// How the device's map compares with the driver's.
struct Identity {
  enum class Verdict {
    foreign,   ///< no identity: not a node of this project
    equal,     ///< the same fingerprint
    superset,  ///< the device has every point of the driver's map, unchanged, and more
    different  ///< a point is missing or changed there, or its map cannot be read
  };
  Verdict verdict = Verdict::foreign;
  std::uint64_t fingerprint = 0;  ///< the device's
  std::vector<std::string>
      differences;                   ///< one line each, the driver's map first; or why there are none to show
  std::vector<Difference> points{};  ///< the same; empty if the device's map cannot be read
};

/// What `different` means, for people: both fingerprints, then the differences, a line each.
std::string difference_text(const Map& known, const Identity& identity);

/// What `superset` means.
constexpr auto superset_text = "the device has more points than this map; those of this map are unchanged";

/// What to do about a unit of an RTU line that stays silent.
std::string line_remedy(const Connection& line);

/// Why a device that has never answered the request for its identity may not do so (a timeout, or a gateway
/// that cannot reach it), and what to do.
std::string silence_text(const Map& known, const Error& error);

/// Asks the device. An error is a broken connection, or a node that is busy or away: never a difference.
Result<Identity> check_identity(Transport& transport, const Map& known, const MapLoader& load);

}  // namespace coupler::host
