// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/gpio/lost_edges.hpp"

#include <fmt/format.h>

namespace coupler::device {

void LostEdges::note(std::uint32_t count, TimePoint now) {
  if (count == 0) return;
  if (now >= quiet_from_)
    log_->warn(
        fmt::format("{}: edges came faster than they could be taken, at least {} lost; counters and latched "
                    "points may have missed them (the statistics go on counting)",
                    what_, count));
  quiet_from_ = now + std::chrono::seconds(1);
}

}  // namespace coupler::device
