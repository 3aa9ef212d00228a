// SPDX-License-Identifier: Apache-2.0
#include "coupler/plan/picture_layout.hpp"

#include <algorithm>
#include <set>

namespace coupler::plan {

TableLayout::TableLayout(const std::vector<modbus::Range>& shown, Scale scale, double top)
    : scale_(scale), bottom_(top) {
  std::set<std::uint32_t> numbers;
  for (const modbus::Range range : shown)
    for (std::uint32_t row = range.start() / scale.columns; row <= range.last() / scale.columns; ++row)
      numbers.insert(row);
  std::uint32_t expected = 0;
  for (const std::uint32_t number : numbers) {
    const bool after_skip = number != expected;
    if (after_skip) bottom_ += skip;
    rows_.push_back({number * scale.columns, bottom_, after_skip});
    bottom_ += scale.height;
    expected = number + 1;
  }
}

std::vector<Box> TableLayout::boxes(modbus::Range range) const {
  std::vector<Box> result;
  auto row = std::lower_bound(
      rows_.begin(), rows_.end(), range.start(),
      [this](const Row& r, std::uint32_t address) { return r.first + scale_.columns <= address; });
  for (; row != rows_.end() && row->first < range.end(); ++row) {
    const std::uint32_t from = std::max<std::uint32_t>(range.start(), row->first);
    const std::uint32_t to = std::min(range.end(), row->first + scale_.columns);
    result.push_back(
        {left + scale_.cell * (from - row->first), row->y, scale_.cell * (to - from), scale_.height});
  }
  return result;
}

}  // namespace coupler::plan
