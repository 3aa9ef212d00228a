// SPDX-License-Identifier: Apache-2.0
// Which addresses the process image of a node holds, and how much memory that takes. No heap.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "coupler/map/identity.hpp"
#include "coupler/map/map.hpp"

namespace coupler {

/// How many elements the arrays have that a node of a map works on.
struct NodeMemory {
  std::size_t areas = 0;   ///< addresses without a hole: device::Image::Area
  std::size_t cells = 0;   ///< mapped addresses, two bytes each
  std::size_t bits = 0;    ///< of these cells: coils and discrete inputs
  std::size_t links = 0;   ///< counters and latches: device::EdgePoints::Link
  std::size_t pulses = 0;  ///< coils that end by themselves: device::ScheduledOutput
};
NodeMemory node_memory(const Map& map);

enum class Mapped : std::uint8_t { all, readable, writable };

/// Joins ranges that come by their starts, and calls `use` with what is joined.
template <class Use>
class JoinedRanges {
 public:
  explicit JoinedRanges(Use& use) : use_(use) {}
  void add(modbus::Range next) {
    if (start_ != end_ && next.start() > end_) end();
    if (start_ == end_) start_ = end_ = next.start();
    end_ = std::max(end_, next.end());
  }
  void end() {
    if (start_ != end_) use_(modbus::Range::of(start_, end_ - start_));
    start_ = end_ = 0;
  }

 private:
  Use& use_;
  std::uint32_t start_ = 0;
  std::uint32_t end_ = 0;
};

/// Calls `use` with each maximal range of a table's mapped addresses, ascending; the identity area and the
/// register that resets the watchdog among them, except for Mapped::writable. What is read whole is mapped,
/// too: clients ask for all of it.
template <class Use>
void each_range(const Map& map, Table table, Mapped which, Use use) {
  JoinedRanges<Use> ranges(use);
  const auto* area = which == Mapped::writable ? map.read_whole.end() : map.read_whole.begin();
  const auto add_areas = [&](std::uint32_t up_to) {
    for (; area != map.read_whole.end() && index(area->table) <= index(table); ++area) {
      if (area->table != table || area->range.end() > identity::reserved.start()) continue;
      if (area->range.start() > up_to) return;
      ranges.add(area->range);
    }
  };
  for (const Point& point : map.points) {
    if (point.table != table || (which == Mapped::readable && !is_readable(point)) ||
        (which == Mapped::writable && !is_writable(point)))
      continue;
    add_areas(point.address);
    ranges.add(range(point));
  }
  add_areas(identity::reserved.start());
  ranges.end();
  if (which == Mapped::writable) return;
  if (table == Table::input_registers) use(modbus::Range::of(identity::reserved.start(), identity::size));
  if (table == Table::holding_registers && map.service.watchdog.needs_reset()) use(identity::watchdog_reset);
}

}  // namespace coupler
