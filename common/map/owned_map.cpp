// SPDX-License-Identifier: Apache-2.0
#include "common/map/owned_map.hpp"

#include <algorithm>

#include "common/map/crc32.hpp"
#include "common/map/fingerprint.hpp"

namespace coupler {

OwnedMap::OwnedMap() = default;
OwnedMap::~OwnedMap() = default;

std::string_view OwnedMap::keep(std::string text) { return texts_.emplace_back(std::move(text)); }

Span<const std::uint16_t> OwnedMap::keep(std::vector<std::uint16_t> registers) {
  return registers_.emplace_back(std::move(registers));
}

Span<const std::string_view> OwnedMap::keep(std::vector<std::string_view> list) {
  return lists_.emplace_back(std::move(list));
}

Span<const Unreadable> OwnedMap::keep(std::vector<Unreadable> areas) {
  return areas_.emplace_back(std::move(areas));
}

Span<const WatchdogSequences::Write> OwnedMap::keep(std::vector<WatchdogSequences::Write> sequence) {
  return sequences_.emplace_back(std::move(sequence));
}

void OwnedMap::finish(Map head, std::vector<Point> points, std::vector<SimWire> sim) {
  points_ = std::move(points);
  sim_ = std::move(sim);
  std::sort(points_.begin(), points_.end(), canonical_less);
  map_ = head;
  map_.points = points_;
  map_.sim = sim_;
  map_.fingerprint = fingerprint(map_.points);
  map_.text_crc = crc32(map_.text);
}

}  // namespace coupler
