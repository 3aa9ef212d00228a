// SPDX-License-Identifier: Apache-2.0
#include "common/map/identity.hpp"

#include <algorithm>

#include "common/codec/number.hpp"

namespace coupler::identity {

using codec::Order;

Head head_of(const Map& map) {
  return {map.fingerprint, static_cast<std::uint32_t>(map.text.size()), map.text_crc};
}

void write_head(const Head& head, std::uint16_t* area) {
  codec::encode(magic, Order::ABCD, area + at_magic);
  area[at_layout] = layout;
  codec::encode(head.fingerprint, Order::ABCD, area + at_fingerprint);
  codec::encode(head.map_size, Order::ABCD, area + at_map_size);
  codec::encode(head.map_crc, Order::ABCD, area + at_map_crc);
}

std::optional<Head> read_head(const std::array<std::uint16_t, head_size>& area) {
  const std::uint16_t* at = area.data();
  if (codec::decode<std::uint32_t>(at + at_magic, Order::ABCD) != magic || at[at_layout] != layout) return {};
  return Head{codec::decode<std::uint64_t>(at + at_fingerprint, Order::ABCD),
              codec::decode<std::uint32_t>(at + at_map_size, Order::ABCD),
              codec::decode<std::uint32_t>(at + at_map_crc, Order::ABCD)};
}

FileRecord record_at(std::uint32_t first, std::uint32_t map_size) {
  using modbus::records_per_file;
  const std::uint32_t total = (map_size + 1) / 2;
  const std::uint32_t record = first % records_per_file;
  const std::uint32_t left = std::min(total - first, records_per_file - record);
  return {static_cast<std::uint16_t>(1 + first / records_per_file), static_cast<std::uint16_t>(record),
          static_cast<std::uint16_t>(std::min<std::uint32_t>(left, modbus::max_file_registers))};
}

}  // namespace coupler::identity
