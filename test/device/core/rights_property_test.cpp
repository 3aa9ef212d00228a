// SPDX-License-Identifier: Apache-2.0
// Random maps, roles and requests: no bit of a point without the right leaves or enters, and where every
// right is there the node answers as one without roles.
#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "test/device/core/node_under_test.hpp"

namespace coupler::device {
namespace {

using fakes::MapBuilder;

constexpr int places = 40;

class RandomRights : public testing::TestWithParam<unsigned> {
 protected:
  RandomRights() : random_(GetParam()) {}

  int one_of(int count) { return std::uniform_int_distribution<int>(0, count - 1)(random_); }

  /// Points with gaps between them; some registers hold two bits, some values take two registers.
  MapBuilder points() {
    MapBuilder builder;
    for (const Table table : tables)
      for (int at = 0; at < places; at += 1 + (one_of(4) == 0 ? 1 : 0)) {
        const auto address = static_cast<std::uint16_t>(at);
        const std::string name = fmt::format("{}_{}", to_string(table), at);
        const int kind = holds_bits(table) ? 3 : one_of(4);
        if (kind == 0 && table == Table::holding_registers) {
          for (const std::uint8_t bit : {std::uint8_t{2}, std::uint8_t{9}})
            builder.add(table, fmt::format("{}_{}", name, bit), address, codec::Type::BOOL,
                        [bit](Point& point) { point.format.bit = bit; });
        } else if (kind == 1) {
          builder.add(table, name, address, codec::Type::UDINT);
          ++at;
        } else {
          builder.add(table, name, address, holds_bits(table) ? codec::Type::BOOL : codec::Type::UINT);
        }
      }
    return builder;
  }

  std::vector<std::string> some_of(const Map& map) {
    std::vector<std::string> names;
    for (const Point& point : map.points)
      if (one_of(4) != 0) names.emplace_back(point.name);
    return names;
  }

  Pdu request() {
    const int function =
        std::vector<int>{1, 2, 3, 4, 5, 6, 15, 16, 22, 23}[static_cast<std::size_t>(one_of(10))];
    const int address = one_of(places + 3);
    const int count = 1 + one_of(6);
    const auto filling = [&](int bytes) {
      Pdu data{static_cast<std::uint8_t>(bytes)};
      for (int i = 0; i < bytes; ++i) data.push_back(static_cast<std::uint8_t>(one_of(256)));
      return data;
    };
    switch (function) {
      case 5: return pdu(5, {address, one_of(2) == 0 ? 0 : 0xFF00});
      case 6: return pdu(6, {address, one_of(65536)});
      case 15: return pdu(15, {address, count}, filling(1));
      case 16: return pdu(16, {address, count}, filling(2 * count));
      case 22: {
        const int changed[] = {0, 0x8001, 0xFFFF,
                               one_of(65536) & one_of(65536)};  // bits of no point among them
        return pdu(22, {address, ~changed[one_of(4)] & 0xFFFF, one_of(65536)});
      }
      case 23: return pdu(23, {one_of(places), 1 + one_of(4), address, count}, filling(2 * count));
      default: return pdu(function, {address, count});
    }
  }

  std::mt19937 random_;
};

/// Address by address, as the documentation says it.
bool is_allowed(const Map& map, Right right, Table table, int first, int count, int bits = 0xFFFF) {
  for (std::size_t i = 0; i < map.points.size(); ++i) {
    const Point& point = map.points[i];
    if (point.table != table || map.security.roles[0].may(right, i)) continue;
    for (int address = first; address < first + count; ++address)
      if (range(point).contains(static_cast<std::uint32_t>(address)) && (own_bits(point) & bits) != 0)
        return false;
  }
  return true;
}

/// The bits of a register that a mask can change, or all of them if those are no point's.
int changed_bits(const Map& map, int address, int bits) {
  for (const Point& point : map.points)
    if (point.table == Table::holding_registers &&
        range(point).contains(static_cast<std::uint32_t>(address)) && (own_bits(point) & bits) != 0)
      return bits;
  return 0xFFFF;
}

int field(const Pdu& request, std::size_t i) { return request[1 + 2 * i] << 8 | request[2 + 2 * i]; }

bool is_allowed(const Map& map, const Pdu& request) {
  const int address = field(request, 0);
  switch (request[0]) {
    case 1: return is_allowed(map, Right::read, Table::coils, address, field(request, 1));
    case 2: return is_allowed(map, Right::read, Table::discrete_inputs, address, field(request, 1));
    case 3: return is_allowed(map, Right::read, Table::holding_registers, address, field(request, 1));
    case 4: return is_allowed(map, Right::read, Table::input_registers, address, field(request, 1));
    case 5: return is_allowed(map, Right::write, Table::coils, address, 1);
    case 15: return is_allowed(map, Right::write, Table::coils, address, field(request, 1));
    case 6: return is_allowed(map, Right::write, Table::holding_registers, address, 1);
    case 16: return is_allowed(map, Right::write, Table::holding_registers, address, field(request, 1));
    case 22:
      return is_allowed(map, Right::write, Table::holding_registers, address, 1,
                        changed_bits(map, address, ~field(request, 1) & 0xFFFF));
    default:
      return is_allowed(map, Right::read, Table::holding_registers, address, field(request, 1)) &&
             is_allowed(map, Right::write, Table::holding_registers, field(request, 2), field(request, 3));
  }
}

TEST_P(RandomRights, Decide_what_leaves_and_what_enters_and_nothing_else) {
  MapBuilder builder = points();
  NodeUnderTest open(builder.build());
  NodeUnderTest limited(builder.everybody_may(some_of(open.map), some_of(open.map)).build());
  int refused = 0;
  for (int i = 0; i < 2000; ++i) {
    const Pdu request = this->request();
    const Pdu reply = limited.ask(request);
    if (is_allowed(limited.map, request)) {
      ASSERT_EQ(reply, open.ask(request)) << "function " << int{request[0]};
    } else {
      ASSERT_EQ(reply.size(), 2U) << "function " << int{request[0]};
      ASSERT_EQ(reply[0], 0x80 | request[0]);
      if (reply[1] != 1) {  // an address of it is not mapped, too
        ASSERT_EQ(reply, open.ask(request));
      }
      refused += reply[1] == 1 ? 1 : 0;
    }
    ASSERT_EQ(limited.memory.cells, open.memory.cells) << "function " << int{request[0]};
  }
  EXPECT_GT(refused, 100);
}

INSTANTIATE_TEST_SUITE_P(OfSeed, RandomRights, testing::Range(1U, 9U));

}  // namespace
}  // namespace coupler::device
