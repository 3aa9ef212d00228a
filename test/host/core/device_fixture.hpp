// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <optional>
#include <utility>

#include "host/core/device.hpp"
#include "test/fakes/map_builder.hpp"
#include "test/host/core/fake_clock.hpp"
#include "test/host/core/fake_device.hpp"
#include "test/host/core/recording_sink.hpp"

namespace coupler::driver::test {

/// A device that takes its time.
class TimedDevice : public FakeDevice {
 public:
  explicit TimedDevice(FakeClock& clock) : clock_(clock) {}
  Duration reply_time{0};
  bool is_mute = false;  ///< answers the question for its identity only

  Result<> read_registers(Table table, modbus::Range range, std::uint16_t* registers) override {
    clock_.advance(reply_time);
    if (is_mute && range.start() < identity::reserved.start()) {
      requests.emplace_back("unanswered");
      return fail(Timeout{std::chrono::milliseconds(3000)});
    }
    return FakeDevice::read_registers(table, range, registers);
  }

 private:
  FakeClock& clock_;
};

/// The engine on a fake device, a fake clock and a sink that keeps everything.
struct DeviceTest : testing::Test {
  using MapBuilder = fakes::MapBuilder;

  void start(const MapBuilder& builder, Verify verify = Verify::require) {
    owned = builder.build();
    const Map& map = owned->map();
    sink.emplace(map);
    const auto load = [this](std::string_view, std::string_view) { return LoadResult{served, {}}; };
    engine.emplace(map, verify, load, device, clock, *sink);
  }

  /// The device is a node that serves this map.
  void serve(const MapBuilder& builder) {
    served = builder.build();
    device.serve(served->map());
  }

  /// What the thread does: steps, and in between waits for what is due.
  void run_for(Duration duration) {
    const Time end = clock.now() + duration;
    while (clock.now() < end) clock.sleep_until(std::min(engine->step(), end));
  }

  void push(std::string_view point, std::uint16_t value, WriteListener* listener = nullptr) {
    Write write;
    write.point = static_cast<std::uint32_t>(find(owned->map(), point) - owned->map().points.data());
    write.registers[0] = value;
    write.listener = listener;
    engine->push(write);
  }

  FakeClock clock;
  TimedDevice device{clock};
  MapPtr owned;
  MapPtr served;
  std::optional<RecordingSink> sink;
  std::optional<Device> engine;
};

}  // namespace coupler::driver::test
