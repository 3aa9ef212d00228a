// SPDX-License-Identifier: Apache-2.0
#include "coupler/tools/snapshot.hpp"

#include <algorithm>

namespace coupler::tools {

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

}  // namespace coupler::tools
