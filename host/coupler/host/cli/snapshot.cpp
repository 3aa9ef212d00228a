// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/cli/snapshot.hpp"

#include <algorithm>

#include "coupler/map/functions.hpp"

namespace coupler::cli {

std::size_t Snapshot::failed() const {
  return static_cast<std::size_t>(std::count_if(readings.begin(), readings.end(), [](const Reading& reading) {
    return reading.state == Reading::State::failed;
  }));
}

void mark_changes(const Snapshot& before, Snapshot& now) {
  for (std::size_t i = 0; i < now.readings.size(); ++i) {
    const Reading& old = before.readings[i];
    Reading& reading = now.readings[i];
    reading.changed =
        reading.state != old.state || reading.registers != old.registers || reading.why != old.why;
  }
}

bool take_change(const Map& map, const modbus::Change& bit, Snapshot& now) {
  const std::uint16_t level = bit.kind == modbus::Change::Kind::on ? 1 : 0;
  bool any = false;
  for (Reading& reading : now.readings) {
    reading.changed = false;
    const Point& point = map.points[reading.point];
    const modbus::Range range = read_range(point);
    if (reading.state != Reading::State::good || !holds_bits(point.table) ||
        static_cast<std::uint8_t>(read_function(point.table)) != bit.table || !range.contains(bit.address))
      continue;
    std::uint16_t& known = reading.registers[bit.address - range.start()];
    reading.changed = known != level;
    known = level;
    any = any || reading.changed;
  }
  return any;
}

}  // namespace coupler::cli
