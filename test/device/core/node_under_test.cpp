// SPDX-License-Identifier: Apache-2.0
#include "test/device/core/node_under_test.hpp"

#include <array>
#include <utility>

namespace coupler::device {

Pdu pdu(int function, std::initializer_list<int> fields, const Pdu& rest) {
  Pdu bytes{static_cast<std::uint8_t>(function)};
  for (const int field : fields) {
    bytes.push_back(static_cast<std::uint8_t>(field >> 8));
    bytes.push_back(static_cast<std::uint8_t>(field));
  }
  bytes.insert(bytes.end(), rest.begin(), rest.end());
  return bytes;
}

OwnedImage::OwnedImage(const Map& map)
    : areas(node_memory(map).areas), cells(node_memory(map).cells), image(map, areas, cells) {}

NodeUnderTest::NodeUnderTest(MapPtr of) : owner(std::move(of)) {}
NodeUnderTest::~NodeUnderTest() = default;

Pdu NodeUnderTest::ask(ClientSession& who, const Pdu& request) {
  std::array<std::uint8_t, modbus::max_pdu_size> reply{};
  const std::size_t size = handler.handle(request, who, now, reply);
  return Pdu(reply.data(), reply.data() + size);
}

}  // namespace coupler::device
