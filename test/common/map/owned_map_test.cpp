// SPDX-License-Identifier: Apache-2.0
#include "coupler/map/owned_map.hpp"

#include <gtest/gtest.h>

#include "coupler/map/fingerprint.hpp"
#include "test/common/map/sample_points.hpp"

namespace coupler {
namespace {

TEST(OwnedMap, What_it_keeps_stays_where_it_is) {
  OwnedMap owned;
  const std::string_view first = owned.keep("a");
  const Span<const std::uint16_t> registers = owned.keep(std::vector<std::uint16_t>{7});
  for (int i = 0; i < 1000; ++i) {
    owned.keep("another text " + std::to_string(i));
    owned.keep(std::vector<std::uint16_t>(3));
  }
  EXPECT_EQ(first, "a");
  EXPECT_EQ(registers[0], 7);
}

TEST(OwnedMap, Finishing_sorts_the_points_by_table_address_part_and_name) {
  auto points = test::sample_points();
  points.push_back(test::value("high", Table::input_registers, 9, {codec::Type::BYTE}));
  points.push_back(test::value("whole", Table::input_registers, 9, {codec::Type::INT}));
  points.push_back(test::bit("a_valve", Table::coils, 3));
  std::vector<std::string_view> names;
  const MapPtr owned = test::map_of(points);
  for (const Point& point : owned->map().points) names.push_back(point.name);
  const std::vector<std::string_view> expected{"a_valve", "valve", "whole", "high",
                                               "state",   "ready", "speed", "name"};
  EXPECT_EQ(names, expected);
}

TEST(OwnedMap, A_point_is_found_by_its_name) {
  const MapPtr owned = test::map_of(test::sample_points());
  ASSERT_NE(find(owned->map(), "speed"), nullptr);
  EXPECT_EQ(find(owned->map(), "speed")->address, 7);
  EXPECT_EQ(find(owned->map(), "spee"), nullptr);
}

TEST(OwnedMap, The_checksum_is_that_of_ieee_802_3) {
  EXPECT_EQ(crc32("123456789"), 0xCBF43926U);
  EXPECT_EQ(crc32(""), 0U);
  EXPECT_EQ(test::map_of({}, "123456789")->map().text_crc, 0xCBF43926U);
}

}  // namespace
}  // namespace coupler
