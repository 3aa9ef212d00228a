// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <initializer_list>
#include <vector>

#include "coupler/device/core/handler.hpp"
#include "coupler/map/image_layout.hpp"
#include "test/device/core/fake_channels.hpp"
#include "test/device/core/fake_lines.hpp"
#include "test/fakes/map_builder.hpp"

namespace coupler::device {

using Pdu = std::vector<std::uint8_t>;

/// A PDU of a function code, 16-bit fields and further bytes.
Pdu pdu(int function, std::initializer_list<int> fields, const Pdu& rest = {});

/// An image with its storage.
struct OwnedImage {
  explicit OwnedImage(const Map& map);
  std::vector<Image::Area> areas;
  std::vector<std::uint16_t> cells;
  Image image;
};

/// Tells the time that the test says.
class FakeClock final : public Clock {
 public:
  explicit FakeClock(const TimePoint& now) : now_(now) {}
  TimePoint now() const override { return now_; }

 private:
  const TimePoint& now_;
};

/// Remembers what it was told.
class FakeScheduleSink final : public ScheduleSink {
 public:
  void add_outcome(const modbus::Change& outcome, const ClientSession*) override { told.push_back(outcome); }
  std::vector<modbus::Change> told;
};

/// The core with hardware that obeys the test.
struct NodeUnderTest {
  explicit NodeUnderTest(MapPtr of);
  ~NodeUnderTest();

  Pdu ask(const Pdu& request) { return ask(session, request); }
  Pdu ask(ClientSession& who, const Pdu& request);

  MapPtr owner;
  const Map& map = owner->map();
  OwnedImage memory{map};
  Image& image = memory.image;
  FakeLines lines;
  FakeChannels channels;
  AnaloguePoints analogue{map, image, channels};
  ClientSession session;
  Statistics statistics;
  TimePoint now{};
  OutputWatchdog watchdog{map.service.watchdog};
  std::vector<EdgePoints::Link> links{node_memory(map).links};
  std::vector<ChangeRing::Entry> ring{32};
  std::vector<std::uint16_t> told = std::vector<std::uint16_t>(image.bits().size());
  Changes changes{image, ring, told};
  std::vector<ScheduledOutput> scheduled{64 + node_memory(map).pulses};
  FakeScheduleSink outcomes;
  OutputSchedule schedule{scheduled, &outcomes, node_memory(map).pulses};
  FakeClock clock{now};
  Handler handler{
      map, Hardware(lines, &analogue), {image, statistics, watchdog, links, changes, schedule}, &clock};
};

}  // namespace coupler::device
