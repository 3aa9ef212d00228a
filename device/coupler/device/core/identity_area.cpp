// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/core/identity_area.hpp"

#include <algorithm>

#include "coupler/codec/number.hpp"

namespace coupler::device {
namespace {

Span<std::uint16_t> area_of(Image& image) {
  return image.find(Table::input_registers, modbus::Range::of(identity::reserved.start(), identity::size));
}

}  // namespace

void write_identity(const Map& map, const identity::Machine& machine, Image& image) {
  const auto area = area_of(image);
  identity::write_head(identity::head_of(map), area.data());
  identity::write_machine(machine, area.data());
}

void write_statistics(const Statistics& statistics, TimePoint now, Image& image) {
  const auto area = area_of(image);
  const auto put = [&](std::size_t at, std::uint32_t value) {
    codec::encode(value, codec::Order::ABCD, &area[at]);
  };
  const auto uptime = std::chrono::duration_cast<std::chrono::seconds>(now - statistics.started);
  put(identity::at_uptime, static_cast<std::uint32_t>(uptime.count()));
  put(identity::at_requests, statistics.requests);
  put(identity::at_exceptions, statistics.exceptions);
  put(identity::at_connections, statistics.connections);
  put(identity::at_hardware_errors, statistics.hardware_errors);
  put(identity::at_watchdog_trips, statistics.watchdog_trips);
  put(identity::at_events_lost, statistics.events_lost);
  for (std::size_t i = 0; i < statistics.exceptions_of.size(); ++i)
    put(identity::at_exceptions_of + 2 * i, statistics.exceptions_of[i]);
  put(identity::at_refusals, statistics.refusals);
  put(identity::at_evictions, statistics.evictions);
  put(identity::at_foreign_units, statistics.foreign_units);
  put(identity::at_bad_frames, statistics.bad_frames);
  put(identity::at_timeouts, statistics.timeouts);
}

void write_watchdog(const OutputWatchdog& watchdog, TimePoint now, Image& image) {
  const auto area = area_of(image);
  area[identity::at_watchdog_state] = static_cast<std::uint16_t>(watchdog.state());
  area[identity::at_watchdog_left] =
      static_cast<std::uint16_t>(std::min<std::int64_t>(watchdog.left(now).count(), 0xFFFF));
}

}  // namespace coupler::device
