// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/node/shared_state.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

#include "coupler/device/core/each_point.hpp"
#include "coupler/map/lookup_by_name.hpp"
#include "coupler/map/same_value.hpp"

namespace coupler::device {
namespace {

Statistics started_at(TimePoint now) {
  Statistics statistics;
  statistics.started = now;
  return statistics;
}

/// Returns whether both drive the same hardware, as far as the map says.
bool same_hardware(const Point& a, const Point& b) {
  const auto hardware = [](const Point& p) {
    return std::tie(p.line.chip, p.line.offset, p.line.name, p.iio.device, p.iio.channel, p.pwm.chip,
                    p.pwm.channel);
  };
  return hardware(a) == hardware(b);
}

/// Others have the value that their map says, unless somebody sets them from the field side.
bool may_change(const Point& point, bool has_field_side) {
  return has_field_side || is_writable(point) || point.counter.present() || point.latched.present();
}

}  // namespace

SharedState::SharedState(const Map& map, TimePoint now, const identity::Machine& machine)
    : SharedState(map, now, node_memory(map), machine) {}

SharedState::SharedState(const Map& map, TimePoint now, NodeMemory size, const identity::Machine& machine)
    : map_(map),
      areas_(size.areas),
      cells_(size.cells),
      image_(map, areas_, cells_.all()),
      lasting_(1, {started_at(now), OutputWatchdog(map.service.watchdog)}),
      scheduled_(scheduled_outputs + size.pulses),
      links_(size.links),
      machine_(machine) {}

void SharedState::prepare_take_over(const SharedState& before, bool has_field_side) {
  LookupByName known(before.map_.points, [](const Point& point) { return point.name; });
  for (const Point& point : map_.points) {
    if (!may_change(point, has_field_side)) continue;
    const Point* old = known.find(point.name);
    if (old == nullptr || !same_value(*old, point)) continue;
    // A point that shares its register leaves the others' bits alone.
    const std::uint16_t mask = own_bits(point);
    carried_.push_back({&point, old, before.image_.find(point.table, range(*old)),
                        image_.find(point.table, range(point)), mask});
  }
}

bool SharedState::fits(const ScheduledOutput& begun, const SharedState& before) const {
  const auto same =
      static_cast<std::size_t>(std::count_if(carried_.begin(), carried_.end(), [&](const Carried& carried) {
        const Point& old = *carried.before;
        return old.table == begun.table && range(old).overlaps(begun.range) &&
               old.address == carried.point->address && same_hardware(old, *carried.point) &&
               is_pulsed(old) == is_pulsed(*carried.point);
      }));
  return same == touched_points(before.map_, begun.table, begun.range).size() &&
         same == touched_points(map_, begun.table, begun.range).size();
}

/// Those of clients keep their places, pulses get the next one.
void SharedState::take_over_schedule(const SharedState& before) {
  std::size_t pulse = scheduled_outputs;
  for (std::size_t i = 0; i < before.scheduled_.all().size(); ++i) {
    const ScheduledOutput& begun = before.scheduled_[i];
    if (begun.state != ScheduledOutput::State::begun || !fits(begun, before)) continue;
    scheduled_[i < scheduled_outputs ? i : pulse++] = begun;
  }
}

void SharedState::take_over(const SharedState& before, TimePoint now) {
  statistics() = before.lasting_[0].statistics;
  watchdog().take_over(before.lasting_[0].watchdog, now);
  take_over_schedule(before);
  for (const Carried& carried : std::exchange(carried_, {}))
    for (std::size_t i = 0; i < carried.to.size(); ++i)
      carried.to[i] =
          static_cast<std::uint16_t>((carried.to[i] & ~carried.mask) | (carried.from[i] & carried.mask));
}

}  // namespace coupler::device
