// SPDX-License-Identifier: Apache-2.0
#include "coupler/plan/intervals.hpp"

#include <algorithm>

namespace coupler::plan {

using modbus::Range;

Intervals::Intervals(std::vector<Range> ranges) {
  std::sort(ranges.begin(), ranges.end(), [](Range a, Range b) { return a.start() < b.start(); });
  for (const Range range : ranges) {
    if (!merged_.empty() && range.start() <= merged_.back().end()) {
      const std::uint32_t start = merged_.back().start();
      merged_.back() = Range::of(start, std::max(merged_.back().end(), range.end()) - start);
    } else {
      merged_.push_back(range);
    }
  }
}

bool Intervals::covers(Range range) const {
  const auto next = std::upper_bound(merged_.begin(), merged_.end(), range.start(),
                                     [](std::uint32_t start, Range r) { return start < r.start(); });
  return next != merged_.begin() && std::prev(next)->contains(range);
}

bool Intervals::overlaps(Range range) const {
  const auto first = std::upper_bound(merged_.begin(), merged_.end(), range.start(),
                                      [](std::uint32_t start, Range r) { return start < r.end(); });
  return first != merged_.end() && first->overlaps(range);
}

}  // namespace coupler::plan
