// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/core/refusal.hpp"

#include <fmt/format.h>

namespace coupler::host {

std::string to_string(const Refusal& refusal) {
  const auto table = to_string(refusal.table);
  const unsigned first = refusal.range.start();
  const unsigned last = refusal.range.last();
  if (refusal.between_points)
    return fmt::format(
        "{0} {1} to {2}, between points, are rejected and left out while this connection lasts; to spare the "
        "attempt add to the map (addresses on the wire): unreadable: [{{table: {0}, from: {1}, to: {2}}}]",
        table, first, last);
  return fmt::format(
      "{} {} to {} are rejected in one request and read in parts; if the device takes fewer than {} in one, "
      "say so in the map: limits: {{{}: ...}}",
      table, first, last, refusal.range.count(), holds_bits(refusal.table) ? "read_bits" : "read_registers");
}

}  // namespace coupler::host
