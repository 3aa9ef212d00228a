// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "coupler/map/identity.hpp"
#include "test/device/core/node_under_test.hpp"

namespace coupler::device {
namespace {

using codec::Type;
using fakes::MapBuilder;
using modbus::Range;

constexpr Table holding = Table::holding_registers;

TEST(Image, Only_what_the_map_says_exists) {
  const auto map = MapBuilder().many(holding, 10, 5).many(holding, 20, 1).build();
  const OwnedImage memory(map->map());
  const auto found = [&](unsigned start, unsigned count) {
    return memory.image.find(holding, Range::of(start, count)).size();
  };
  EXPECT_EQ(found(10, 5), 5U);
  EXPECT_EQ(found(12, 2), 2U);
  EXPECT_EQ(found(20, 1), 1U);
  EXPECT_EQ(found(9, 1), 0U);
  EXPECT_EQ(found(9, 2), 0U);
  EXPECT_EQ(found(14, 2), 0U) << "the range runs into a hole";
  EXPECT_EQ(found(10, 11), 0U) << "the range spans a hole";
  EXPECT_EQ(found(0, 65536), 0U);
  EXPECT_TRUE(memory.image.find(Table::coils, Range::of(10, 1)).empty());
}

TEST(Image, Points_beside_each_other_make_one_area_across_types_and_shared_registers) {
  const auto map =
      MapBuilder()
          .add(holding, "wide", 0, Type::LREAL)
          .add(holding, "upper", 4, Type::BYTE)
          .add(holding, "lower", 4, Type::BYTE, [](Point& p) { p.format.half = codec::Half::low; })
          .add(holding, "flag", 5, Type::BOOL, [](Point& p) { p.format.bit = 7; })
          .build();
  const OwnedImage memory(map->map());
  EXPECT_EQ(memory.image.find(holding, Range::of(0, 6)).size(), 6U);
  EXPECT_TRUE(memory.image.find(holding, Range::of(0, 7)).empty());
}

TEST(Image, Every_address_has_its_own_cell) {
  const auto map = MapBuilder()
                       .many(Table::coils, 0, 3)
                       .many(Table::discrete_inputs, 0, 3)
                       .many(Table::input_registers, 0, 3)
                       .many(holding, 0, 3)
                       .many(holding, 8, 2)
                       .build();
  const OwnedImage memory(map->map());
  std::uint16_t next = 1;
  for (const Point& point : map->map().points) memory.image.find(point.table, range(point))[0] = next++;
  next = 1;
  for (const Point& point : map->map().points)
    EXPECT_EQ(memory.image.find(point.table, range(point))[0], next++) << point.name;
}

TEST(Image, The_last_address_of_a_table_can_be_mapped) {
  const auto map = MapBuilder().many(Table::coils, 65535, 1).build();
  const OwnedImage memory(map->map());
  EXPECT_EQ(memory.image.find(Table::coils, Range::of(65535, 1)).size(), 1U);
}

TEST(Image, It_starts_with_the_initial_values_and_points_in_one_register_keep_their_bits) {
  MapBuilder builder;
  const auto values = builder.keep({0x1234, 0x5678});
  const auto high = builder.keep({0xAB00});
  const auto bit = builder.keep({0x0008});
  const auto on = builder.keep({1});
  const auto map =
      builder.add(holding, "wide", 0, Type::DWORD, [&](Point& p) { p.initial = values; })
          .add(holding, "upper", 2, Type::BYTE, [&](Point& p) { p.initial = high; })
          .add(holding, "flag", 2, Type::BOOL, [&](Point& p) { p.format.bit = 3, p.initial = bit; })
          .add(Table::coils, "out", 7, Type::BOOL, [&](Point& p) { p.initial = on; })
          .many(holding, 3, 1)
          .build();
  const OwnedImage memory(map->map());
  const auto cells = memory.image.find(holding, Range::of(0, 4));
  EXPECT_EQ(cells[0], 0x1234);
  EXPECT_EQ(cells[1], 0x5678);
  EXPECT_EQ(cells[2], 0xAB08);
  EXPECT_EQ(cells[3], 0);
  EXPECT_EQ(memory.image.find(Table::coils, Range::of(7, 1))[0], 1);
}

TEST(Image, A_point_that_is_only_read_cannot_be_written) {
  const auto map = MapBuilder()
                       .many(holding, 0, 2)
                       .add(holding, "fixed", 2, Type::WORD, [](Point& p) { p.access = Access::read; })
                       .many(holding, 3, 1)
                       .build();
  const OwnedImage memory(map->map());
  EXPECT_EQ(memory.image.find(holding, Range::of(0, 4)).size(), 4U);
  EXPECT_EQ(memory.image.find_writable(holding, Range::of(0, 2)).size(), 2U);
  EXPECT_EQ(memory.image.find_writable(holding, Range::of(3, 1)).size(), 1U);
  EXPECT_TRUE(memory.image.find_writable(holding, Range::of(2, 1)).empty());
  EXPECT_TRUE(memory.image.find_writable(holding, Range::of(1, 3)).empty());
}

TEST(Image, A_point_that_is_only_written_cannot_be_read_unless_another_reads_there) {
  const auto map = MapBuilder()
                       .many(holding, 0, 1)
                       .add(holding, "wish", 1, Type::WORD, [](Point& p) { p.access = Access::write; })
                       .add(holding, "wanted", 2, Type::WORD, [](Point& p) { p.access = Access::write; })
                       .add(holding, "actual", 2, Type::WORD, [](Point& p) { p.access = Access::read; })
                       .build();
  const OwnedImage memory(map->map());
  EXPECT_EQ(memory.image.find_readable(holding, Range::of(0, 1)).size(), 1U);
  EXPECT_TRUE(memory.image.find_readable(holding, Range::of(0, 2)).empty());
  EXPECT_TRUE(memory.image.find_readable(holding, Range::of(1, 1)).empty());
  EXPECT_EQ(memory.image.find_readable(holding, Range::of(2, 1)).size(), 1U);
  EXPECT_EQ(memory.image.find_writable(holding, Range::of(0, 3)).size(), 3U);
}

TEST(Image, The_identity_area_is_always_there) {
  const auto map = MapBuilder().build();
  const OwnedImage memory(map->map());
  EXPECT_EQ(memory.image.find(Table::input_registers, Range::of(0xFF00, identity::size)).size(),
            identity::size);
  EXPECT_TRUE(memory.image.find(Table::input_registers, Range::of(0xFF00, identity::size + 1)).empty());
}

}  // namespace
}  // namespace coupler::device
