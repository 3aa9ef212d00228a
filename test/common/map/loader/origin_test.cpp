// SPDX-License-Identifier: Apache-2.0
// Files of ros-modbus-device-driver load unchanged, with the same meaning.
#include <gtest/gtest.h>

#include <filesystem>

#include "test/common/map/loader/loaded.hpp"
#include "test/support/paths.hpp"

namespace coupler {
namespace {

using codec::Order;
using codec::Type;
using namespace std::chrono_literals;

MapPtr load(const std::string& path) {
  const LoadResult result = load_map_file(path);
  EXPECT_FALSE(has_errors(result.diagnostics)) << test::text_of(result.diagnostics);
  return result.map;
}

TEST(Origin, A_commented_file_with_trailing_commas_loads) {
  const MapPtr owned = load(test::in_tree("test/maps/origin/commented.json"));
  ASSERT_NE(owned, nullptr);
  const Map& map = owned->map();
  EXPECT_EQ(map.name, "weldingcell");
  EXPECT_EQ(map.connection.address, "192.168.7.20");
  EXPECT_EQ(map.connection.port, 1502);
  EXPECT_EQ(map.connection.unit, 7);
  EXPECT_EQ(map.connection.timeout, 500ms);
  EXPECT_EQ(map.polling.rate, 25);
  EXPECT_TRUE(map.polling.discrete_continuous);
  EXPECT_EQ(map.polling.discrete_gap, 32);
  EXPECT_FALSE(map.polling.register_continuous);
  EXPECT_EQ(map.polling.register_gap, 12);
  ASSERT_EQ(map.points.size(), 6U);
  EXPECT_EQ(find(map, "torch")->address, 1);
  EXPECT_EQ(find(map, "torch")->access, Access::read_write);
  EXPECT_EQ(find(map, "door")->address, 10001);
  EXPECT_EQ(find(map, "door")->access, Access::read);
}

TEST(Origin, Wide_values_have_the_least_significant_register_first_by_default) {
  const MapPtr owned = load(test::in_tree("test/maps/origin/commented.json"));
  ASSERT_NE(owned, nullptr);
  const codec::Format current = find(owned->map(), "current")->format;
  EXPECT_EQ(current.type, Type::REAL);
  EXPECT_EQ(current.order, Order::CDAB);
}

TEST(Origin, A_string_swaps_its_characters_by_default) {
  const MapPtr owned = load(test::in_tree("test/maps/origin/commented.json"));
  ASSERT_NE(owned, nullptr);
  const codec::Format program = find(owned->map(), "program")->format;
  EXPECT_EQ(program.type, Type::STRING);
  EXPECT_EQ(program.length, 12);
  EXPECT_EQ(program.order, Order::BADC);
}

TEST(Origin, A_plain_file_loads_without_a_word) {
  const LoadResult result = load_map_file(test::in_tree("test/maps/origin/plain.json"));
  EXPECT_EQ(test::text_of(result.diagnostics), "");
  ASSERT_NE(result.map, nullptr);
  const Map& map = result.map->map();
  EXPECT_EQ(map.connection.port, 502);
  EXPECT_EQ(map.connection.unit, 1);
  EXPECT_EQ(map.polling.rate, 10);
  EXPECT_EQ(map.polling.discrete_gap, 64);
  EXPECT_EQ(map.polling.register_gap, 20) << "'register_read_separation_gap' is the same key";
  EXPECT_EQ(find(map, "distance")->format.order, Order::BADC) << "byteorder_reverse, one register";
  EXPECT_EQ(find(map, "fault")->format.half, codec::Half::high) << "in any case";
}

TEST(Origin, A_name_may_come_from_elsewhere) {
  const std::string text = "mapping: {coils: {a: , b: 3}}";
  const LockFile renew{"m.yaml.lock", std::nullopt, LockUse::renew};
  const LoadResult result = load_map_with_lock(text, "m.yaml", renew, "press");
  EXPECT_EQ(test::text_of(result.diagnostics), "");
  ASSERT_NE(result.map, nullptr);
  EXPECT_EQ(result.map->map().name, "press");
  EXPECT_TRUE(has_errors(load_map_with_lock(text, "m.yaml", renew, "no name").diagnostics));
  EXPECT_EQ(load_map_with_lock("name: belt\n" + text, "m.yaml", renew, "press").map->map().name, "belt");
}

TEST(Origin, An_address_is_decimal_whatever_zeros_lead_it) {
  const MapPtr owned = load(test::in_tree("test/maps/origin/short.yaml"));
  ASSERT_NE(owned, nullptr);
  EXPECT_EQ(find(owned->map(), "gate")->address, 10);
}

TEST(Origin, The_shared_fixtures_load_unchanged) {
  const std::filesystem::path fixtures = "/work/shared/fixtures";
  if (!std::filesystem::exists(fixtures)) GTEST_SKIP() << "no " << fixtures << " on this machine";
  for (const auto& file : std::filesystem::directory_iterator(fixtures))
    EXPECT_NE(load(file.path().string()), nullptr) << file.path();
}

}  // namespace
}  // namespace coupler
