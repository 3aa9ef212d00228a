// SPDX-License-Identifier: Apache-2.0
#include "coupler/map/image_layout.hpp"

namespace coupler {

NodeMemory node_memory(const Map& map) {
  NodeMemory memory;
  for (const Table table : tables) {
    each_range(map, table, Mapped::all, [&](modbus::Range range) {
      ++memory.areas;
      memory.cells += range.count();
      if (holds_bits(table)) memory.bits += range.count();
    });
    if (!is_writable(table)) continue;
    for (const Mapped which : {Mapped::readable, Mapped::writable})
      each_range(map, table, which, [&](modbus::Range) { ++memory.areas; });
  }
  for (const Point& point : map.points) {
    memory.links += point.counter.present() + point.latched.present();
    if (is_pulsed(point)) memory.pulses += point.count;
  }
  return memory;
}

}  // namespace coupler
