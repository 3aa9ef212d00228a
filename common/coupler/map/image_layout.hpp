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

/// Calls `use` with each maximal range of a table's mapped addresses, ascending; the identity area and the
/// register that resets the watchdog among them, except for Mapped::writable.
template <class Use>
void each_range(const Map& map, Table table, Mapped which, Use use) {
  std::uint32_t start = 0;
  std::uint32_t end = 0;
  for (const Point& point : map.points) {
    if (point.table != table || (which == Mapped::readable && !is_readable(point)) ||
        (which == Mapped::writable && !is_writable(point)))
      continue;
    const modbus::Range next = range(point);
    if (start != end && next.start() > end) use(modbus::Range::of(start, end - start));
    if (start == end || next.start() > end) start = next.start();
    end = std::max(end, next.end());
  }
  if (start != end) use(modbus::Range::of(start, end - start));
  if (which == Mapped::writable) return;
  if (table == Table::input_registers) use(modbus::Range::of(identity::reserved.start(), identity::size));
  if (table == Table::holding_registers && map.service.watchdog.needs_reset()) use(identity::watchdog_reset);
}

}  // namespace coupler
