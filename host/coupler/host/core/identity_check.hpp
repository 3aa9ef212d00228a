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
    foreign,   ///< no identity; the device is not a node of this project
    equal,     ///< both have the same fingerprint
    superset,  ///< the device has every point of the driver's map, unchanged, and more
    different  ///< a point is missing or changed in the device's map, or that cannot be read
  };
  Verdict verdict = Verdict::foreign;
  std::uint64_t fingerprint = 0;         ///< that of the device's map
  std::vector<std::string> differences;  ///< one line for each difference, the driver's map first; or the
                                         ///< reason why there are none
  std::vector<Difference> points{};      ///< the same as data; empty if the device's map cannot be read
};

/// Returns a text for people that explains `different`: both fingerprints, then the differences, a line each.
std::string difference_text(const Map& known, const Identity& identity);

/// A point of the driver's map that must not be read, because it is missing or different in the device's
/// map, or because the maps cannot be compared.
struct ForeignPoint {
  std::uint32_t point;  ///< index into Map::points
  std::string why;
};
/// Returns the points of `known` that must not be read from a device with that identity.
std::vector<ForeignPoint> foreign_points(const Map& known, const Identity& identity);

/// Returns a text for people that explains `superset`.
constexpr auto superset_text = "the device has more points than this map; those of this map are unchanged";

/// Returns what to do about a unit of an RTU line that stays silent.
std::string line_remedy(const Connection& line);

/// The remedy for a device that accepts connections and answers nothing.
constexpr auto silent_unit_remedy = "check that the device runs, and that 'unit' is its unit id";

/// Returns why a device may not answer the request for its identity (a timeout, or a gateway that cannot
/// reach it), and what to do.
std::string silence_text(const Map& known, const Error& error);

/// Asks the device. An error is a broken connection, or a node that is busy or away, but never a difference.
Result<Identity> check_identity(Link& link, const Map& known, const MapLoader& load);

}  // namespace coupler::host
