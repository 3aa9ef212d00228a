// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/cli/identity_findings.hpp"

#include "coupler/map/node_address.hpp"

namespace coupler::cli {
namespace {

using Verdict = host::Identity::Verdict;

std::string difference_note(const Map& map, const host::Identity& identity) {
  return difference_text(map, identity) + "\nOnly what is the same is read. For the device's own map give " +
         node_address_text(map.connection) + " in place of this one";
}

}  // namespace

IdentityFindings findings(const Map& map, const host::Identity& identity) {
  if (identity.verdict == Verdict::superset) return {{host::superset_text}, {}};
  if (identity.verdict != Verdict::different) return {};
  IdentityFindings found{{difference_note(map, identity)}, {}};
  for (const Difference& difference : identity.points) {
    if (!is_breaking(difference.kind)) continue;
    const bool missing = difference.kind == Difference::Kind::missing;
    const auto point = static_cast<std::uint32_t>(find(map, difference.point) - map.points.begin());
    found.left_out.push_back(
        {point, missing ? "not in the device's map" : "another one in the device's map: " + difference.what});
  }
  if (identity.points.empty())
    for (std::uint32_t point = 0; point < map.points.size(); ++point)
      found.left_out.push_back({point, "the device's map cannot be compared"});
  return found;
}

}  // namespace coupler::cli
