// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/motion/change_history.hpp"

#include "coupler/map/published.hpp"

namespace coupler::host {

bool ChangeHistory::keeps(std::uint32_t point) const {
  return host_registers(map_.points[point]) <= most_registers;
}

void ChangeHistory::see(std::uint32_t point, const Stamp& stamp, const std::uint16_t* registers,
                        bool is_told) {
  if (!keeps(point)) return;
  Last& last = last_[point];
  Registers now{};
  std::copy_n(registers, host_registers(map_.points[point]), now.begin());
  if (!last.known || last.registers != now)
    keep({point, last.known, last.registers, is_told ? stamp : last.stamp, now, stamp});
  last = {now, stamp, true};
}

void ChangeHistory::keep(const Change& change) {
  if (changes_.size() < most_changes) {
    changes_.push_back(change);
    return;
  }
  Change& oldest = changes_[oldest_];
  forgotten_ = std::max(forgotten_, oldest.stamp.at + oldest.stamp.uncertainty);
  oldest = change;
  oldest_ = (oldest_ + 1) % most_changes;
}

void ChangeHistory::lose_all() {
  for (Last& last : last_) last.known = false;
}

void ChangeHistory::each_since(std::uint32_t point, Time since,
                               const std::function<void(const Change&)>& see) const {
  for (std::size_t i = 0; i < changes_.size(); ++i) {
    const Change& change = changes_[(oldest_ + i) % changes_.size()];
    if (change.point == point && change.stamp.at + change.stamp.uncertainty >= since) see(change);
  }
}

}  // namespace coupler::host
