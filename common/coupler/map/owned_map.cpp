// SPDX-License-Identifier: Apache-2.0
#include "coupler/map/owned_map.hpp"

#include <algorithm>

#include "coupler/map/fingerprint.hpp"

namespace coupler {

OwnedMap::OwnedMap() = default;
OwnedMap::~OwnedMap() = default;

std::shared_ptr<OwnedMap> OwnedMap::make() {
  return std::allocate_shared<OwnedMap>(std::pmr::polymorphic_allocator<OwnedMap>());
}

std::string_view OwnedMap::keep(const std::string& text) { return texts_.emplace_back(text); }

Span<const std::uint16_t> OwnedMap::keep(const std::vector<std::uint16_t>& registers) {
  return registers_.emplace_back(registers.begin(), registers.end());
}

Span<const std::string_view> OwnedMap::keep(const std::vector<std::string_view>& list) {
  return lists_.emplace_back(list.begin(), list.end());
}

Span<const NamedValue> OwnedMap::keep(const std::vector<NamedValue>& values) {
  return values_.emplace_back(values.begin(), values.end());
}

Span<const RawRange> OwnedMap::keep(const std::vector<RawRange>& ranges) {
  return raw_ranges_.emplace_back(ranges.begin(), ranges.end());
}

Span<const TableRange> OwnedMap::keep(const std::vector<TableRange>& areas) {
  return areas_.emplace_back(areas.begin(), areas.end());
}

Span<const WatchdogSequences::Write> OwnedMap::keep(const std::vector<WatchdogSequences::Write>& sequence) {
  return sequences_.emplace_back(sequence.begin(), sequence.end());
}

Span<const Role> OwnedMap::keep(const std::vector<Role>& roles) {
  roles_.assign(roles.begin(), roles.end());
  return roles_;
}

Span<const std::uint8_t> OwnedMap::keep(const std::vector<std::uint8_t>& rights) {
  return rights_.emplace_back(rights.begin(), rights.end());
}

Span<const Tool> OwnedMap::keep(const std::vector<Tool>& tools) {
  tools_.assign(tools.begin(), tools.end());
  return tools_;
}

Span<const AxisPosition> OwnedMap::keep(const std::vector<AxisPosition>& positions) {
  return positions_.emplace_back(positions.begin(), positions.end());
}

Span<const Axis> OwnedMap::keep(const std::vector<Axis>& axes) {
  axes_.assign(axes.begin(), axes.end());
  return axes_;
}

void OwnedMap::finish(Map head, const std::vector<Point>& points, const std::vector<SimWire>& sim) {
  points_.assign(points.begin(), points.end());
  sim_.assign(sim.begin(), sim.end());
  std::sort(points_.begin(), points_.end(), canonical_less);
  map_ = head;
  map_.points = points_;
  map_.sim = sim_;
  map_.fingerprint = fingerprint(map_.points);
  map_.text_crc = crc32(map_.text);
}

}  // namespace coupler
