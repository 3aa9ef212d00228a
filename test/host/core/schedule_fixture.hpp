// SPDX-License-Identifier: Apache-2.0
// A device that is asked to have values at a time.
#pragma once

#include <chrono>
#include <future>
#include <string>
#include <string_view>

#include "test/host/core/changes_fixture.hpp"

namespace coupler::host::test {

using Became = ScheduledOutcome::Result;

struct TimedOutputsTest : ChangesTest {
  /// A lamp (coil 5), a horn that cannot be read (coil 6), a speed (holding register 2).
  static MapBuilder press() {
    MapBuilder builder;
    builder.coil("lamp", 5).command("horn", 6).holding("speed", 2);
    builder.head().connection.timeout = milliseconds(3000);
    return builder;
  }
  void begin_foreign(const MapBuilder& builder) {
    start(builder);
    run_for(milliseconds(10));
    device.requests.clear();
  }
  void begin_node(const MapBuilder& builder) {
    serve(builder);
    device.schedule_outputs();
    start(builder);
    run_for(milliseconds(10));
    device.requests.clear();
  }

  ScheduledWrite wanted(std::string_view point, std::uint16_t value, Duration in,
                        milliseconds lasts = milliseconds(0)) const {
    ScheduledWrite what;
    what.write.point = static_cast<std::uint32_t>(find(owned->map(), point) - owned->map().points.data());
    what.write.registers[0] = value;
    what.due = clock.now() + in;
    what.duration = lasts;
    return what;
  }
  ScheduleAnswer schedule(const ScheduledWrite& what) {
    auto answer = engine->schedule(what);
    engine->step();
    EXPECT_EQ(answer.wait_for(std::chrono::seconds(0)), std::future_status::ready);
    return answer.get();
  }
  ScheduleAnswer schedule(std::string_view point, std::uint16_t value, Duration in,
                          milliseconds lasts = milliseconds(0)) {
    return schedule(wanted(point, value, in, lasts));
  }
  std::uint16_t lamp() { return device.values[{Table::coils, 5}]; }
  std::uint16_t speed() { return device.values[{Table::holding_registers, 2}]; }
  /// That there was one more, and no other.
  ScheduledOutcome outcome() {
    EXPECT_EQ(sink->outcomes.size(), 1U);
    if (sink->outcomes.empty()) return {};
    ScheduledOutcome last = sink->outcomes.back();
    sink->outcomes.clear();
    return last;
  }
};

}  // namespace coupler::host::test
