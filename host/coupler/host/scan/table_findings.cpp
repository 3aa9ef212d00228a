// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/scan/table_findings.hpp"

#include <algorithm>

namespace coupler::scan {

TableFindings::TableFindings(Table table, modbus::Range window)
    : table_(table), window_(window), seen_(window.count(), Seen::not_asked), values_(window.count()) {}

void TableFindings::add_values(modbus::Range range, const std::uint16_t* values) {
  const auto first = static_cast<std::ptrdiff_t>(range.start() - window_.start());
  std::fill_n(seen_.begin() + first, range.count(), Seen::readable);
  std::copy_n(values, range.count(), values_.begin() + first);
}

std::uint32_t TableFindings::count(Seen seen) const {
  return static_cast<std::uint32_t>(std::count(seen_.begin(), seen_.end(), seen));
}

std::vector<modbus::Range> TableFindings::readable() const {
  std::vector<modbus::Range> ranges;
  for (std::uint32_t at = window_.start(); at < window_.end();) {
    const std::uint32_t start = at++;
    if (seen(start) != Seen::readable) continue;
    while (at < window_.end() && seen(at) == Seen::readable && seams_.count(at) == 0) ++at;
    ranges.push_back(modbus::Range::of(start, at - start));
  }
  return ranges;
}

std::vector<modbus::Range> TableFindings::holes() const {
  std::vector<modbus::Range> ranges;
  const std::vector<modbus::Range> known = readable();
  for (std::size_t i = 1; i < known.size(); ++i) {
    const std::uint32_t start = known[i - 1].end();
    const auto all_refused = [this](std::uint32_t from, std::uint32_t to) {
      while (from < to && seen(from) == Seen::refused) ++from;
      return from == to;
    };
    if (start < known[i].start() && all_refused(start, known[i].start()))
      ranges.push_back(modbus::Range::of(start, known[i].start() - start));
  }
  return ranges;
}

}  // namespace coupler::scan
