// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>
#include <vector>

#include "coupler/map/owned_map.hpp"

namespace coupler::test {

inline Point bit(std::string_view name, Table table, std::uint16_t address) {
  Point point;
  point.name = name;
  point.table = table;
  point.address = address;
  point.access = is_writable(table) ? Access::read_write : Access::read;
  return point;
}

inline Point value(std::string_view name, Table table, std::uint16_t address, codec::Format format) {
  Point point = bit(name, table, address);
  point.format = format;
  return point;
}

/// One point of each kind, in no order.
inline std::vector<Point> sample_points() {
  using codec::Half;
  using codec::Order;
  using codec::Type;
  codec::Format speed{Type::REAL, Order::CDAB};
  codec::Format state{Type::USINT, Order::ABCD, Half::low};
  codec::Format ready{Type::BOOL, Order::ABCD, Half::high, 15};
  codec::Format text{Type::STRING, Order::BADC, Half::high, 0, 12};
  return {value("name", Table::holding_registers, 40012, text),
          value("ready", Table::input_registers, 9, ready), bit("valve", Table::coils, 3),
          value("state", Table::input_registers, 9, state),
          value("speed", Table::holding_registers, 7, speed)};
}

inline MapPtr map_of(std::vector<Point> points, std::string text = "name: press\n") {
  auto owned = std::make_shared<OwnedMap>();
  Map head;
  head.text = owned->keep(text);
  owned->finish(head, points, {});
  return owned;
}

}  // namespace coupler::test
