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
  Handler handler{map, image, Hardware(lines, &analogue), statistics, watchdog, links};
};

}  // namespace coupler::device
