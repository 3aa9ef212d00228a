// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <utility>
#include <vector>

#include "device/core/handler.hpp"
#include "test/device/core/fake_channels.hpp"
#include "test/device/core/fake_lines.hpp"
#include "test/fakes/map_builder.hpp"

namespace coupler::node {

using Pdu = std::vector<std::uint8_t>;

/// A PDU of a function code, 16-bit fields and further bytes.
inline Pdu pdu(int function, std::initializer_list<int> fields, const Pdu& rest = {}) {
  Pdu bytes{static_cast<std::uint8_t>(function)};
  for (const int field : fields) {
    bytes.push_back(static_cast<std::uint8_t>(field >> 8));
    bytes.push_back(static_cast<std::uint8_t>(field));
  }
  bytes.insert(bytes.end(), rest.begin(), rest.end());
  return bytes;
}

/// An image with its storage.
struct OwnedImage {
  explicit OwnedImage(const Map& map)
      : areas(Image::size_for(map).areas), cells(Image::size_for(map).cells), image(map, areas, cells) {}
  std::vector<Image::Area> areas;
  std::vector<std::uint16_t> cells;
  Image image;
};

/// The core with hardware that obeys the test.
struct NodeUnderTest {
  explicit NodeUnderTest(MapPtr of) : owner(std::move(of)) {}

  Pdu ask(const Pdu& request) { return ask(peer, request); }
  Pdu ask(Peer& who, const Pdu& request) {
    std::array<std::uint8_t, modbus::max_pdu_size> reply{};
    const std::size_t size = handler.handle(request, who, now, reply);
    return Pdu(reply.data(), reply.data() + size);
  }

  MapPtr owner;
  const Map& map = owner->map();
  OwnedImage memory{map};
  Image& image = memory.image;
  FakeLines lines;
  FakeChannels channels;
  AnaloguePoints analogue{map, image, channels};
  Peer peer;
  Statistics statistics;
  TimePoint now{};
  OutputWatchdog watchdog{map.service.watchdog};
  std::vector<EdgePoints::Link> links{EdgePoints::links_for(map)};
  Handler handler{map, image, Hardware(lines, &analogue), statistics, watchdog, links};
};

}  // namespace coupler::node
