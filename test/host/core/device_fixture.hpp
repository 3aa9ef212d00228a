// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <optional>
#include <string_view>

#include "coupler/host/core/device.hpp"
#include "test/fakes/map_builder.hpp"
#include "test/host/core/fake_clock.hpp"
#include "test/host/core/fake_device.hpp"
#include "test/host/core/recording_sink.hpp"

namespace coupler::host::test {

/// A device that takes its time.
class TimedDevice : public FakeDevice {
 public:
  explicit TimedDevice(FakeClock& clock) : clock_(clock) {}
  ~TimedDevice() override;
  Duration reply_time{0};
  bool is_mute = false;  ///< answers the question for its identity only

  Result<modbus::Bytes> receive() override;

 private:
  FakeClock& clock_;
};

/// The engine on a fake device, a fake clock and a sink that keeps everything.
struct DeviceTest : testing::Test {
  using MapBuilder = fakes::MapBuilder;
  DeviceTest();
  ~DeviceTest() override;

  void start(const MapBuilder& builder, Verify verify = Verify::require);
  /// The device is a node that serves this map.
  void serve(const MapBuilder& builder);
  /// What the thread does: steps, and in between waits for what is due.
  void run_for(Duration duration);
  /// What the thread does in a step in which one allocation fails, the one after so many: it gives the
  /// connection up. Returns false if the step makes no more than `allocations`.
  bool step_without_memory(long allocations);
  void push(std::string_view point, std::uint16_t value, WriteListener* listener = nullptr);
  /// Makes the table of `owned`, and the sink.
  void make_sink();
  /// Makes the engine of `owned`, and its link.
  void make_engine(Verify verify, MapLoader load);
  bool is_turn_free();
  /// Calls `step` while another unit has the turn. Once a turn is awaited, calls `meanwhile` in another
  /// thread and gives the turn back.
  void during_wait_for_turn(const std::function<void()>& step, const std::function<void()>& meanwhile);

  FakeClock clock;
  TimedDevice device{clock};
  std::shared_ptr<SharedChannel> shared = share(device);
  std::optional<Link> link;
  MapPtr owned;
  MapPtr served;
  std::optional<ValueTable> table;
  std::optional<RecordingSink> sink;
  std::optional<Device> engine;
};

}  // namespace coupler::host::test
