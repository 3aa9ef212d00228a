// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/core/image.hpp"

#include <algorithm>
#include <cassert>

#include "coupler/map/image_layout.hpp"

namespace coupler::device {
namespace {

using modbus::Range;

const Image::Area* covering(Span<Image::Area> areas, Range range) {
  const auto* after =
      std::upper_bound(areas.begin(), areas.end(), range.start(),
                       [](std::uint32_t address, const auto& area) { return address < area.start; });
  if (after == areas.begin()) return nullptr;
  const Image::Area* area = after - 1;
  return range.end() <= area->end ? area : nullptr;
}

/// A point that shares its register leaves the others' bits alone.
void put_initial(const Point& point, Span<std::uint16_t> cells) {
  const std::uint16_t mask = own_bits(point);
  for (std::size_t i = 0; i < point.initial.size(); ++i)
    cells[i] = static_cast<std::uint16_t>((cells[i] & ~mask) | (point.initial[i] & mask));
}

}  // namespace

Image::Image(const Map& map, Span<Area> areas, Span<std::uint16_t> cells) : cells_(cells) {
  std::size_t used = 0;
  std::uint32_t cell = 0;
  const auto list = [&](Table table, Mapped which) {
    const std::size_t first = used;
    each_range(map, table, which, [&](Range range) {
      areas[used++] = {range.start(), range.end(), cell};
      if (which == Mapped::all) cell += range.count();
    });
    return areas.sub(first, used - first);
  };
  for (const Table table : tables) {
    const std::size_t i = index(table);
    mapped_[i] = list(table, Mapped::all);
    readable_[i] = is_writable(table) ? list(table, Mapped::readable) : mapped_[i];
    if (is_writable(table)) writable_[i] = list(table, Mapped::writable);
    if (holds_bits(table)) bits_ = cell;
  }
  std::fill(cells_.begin(), cells_.end(), std::uint16_t{0});
  for (const Point& point : map.points) put_initial(point, find(point.table, range(point)));
}

Span<std::uint16_t> Image::find(Table table, Range range) const {
  const Area* area = covering(mapped_[index(table)], range);
  if (area == nullptr) return {};
  return cells_.sub(area->cell + (range.start() - area->start), range.count());
}

Span<std::uint16_t> Image::find_readable(Table table, Range range) const {
  return covering(readable_[index(table)], range) == nullptr ? Span<std::uint16_t>() : find(table, range);
}

Span<std::uint16_t> Image::find_writable(Table table, Range range) const {
  return covering(writable_[index(table)], range) == nullptr ? Span<std::uint16_t>() : find(table, range);
}

}  // namespace coupler::device
