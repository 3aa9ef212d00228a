// SPDX-License-Identifier: Apache-2.0
// `axes:`; what is refused has its maps in test/maps/bad.
#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include <fmt/format.h>

#include "coupler/map/joint.hpp"
#include "test/common/map/loader/loaded.hpp"

namespace coupler {
namespace {

constexpr const char* points =
    "mapping:\n"
    "  coils: {valve: 0, horn: 1}\n"
    "  holding_registers:\n"
    "    flag: {address: 0, type: BOOL, bit: 3}\n"
    "    mode: {address: 1, type: INT, values: {-1: back, 0: idle, 7: run}}\n"
    "    step: {address: 2, type: SINT, offset: high}\n"
    "    nibble: {address: 3, type: UINT, bits: [4, 7]}\n"
    "    large: {address: 4, type: ULINT}\n"
    "    level: {address: 8, type: INT, scale: 0.1}\n"
    "    force: {address: 9, type: REAL}\n"
    "    mask: {address: 11, type: WORD}\n";

MapPtr with_axes(const std::string& axes) { return test::load_clean("name: cell\naxes:\n" + axes + points); }

/// Of the only axis.
using Positions = std::vector<std::pair<std::int64_t, double>>;
Positions positions_of(const std::string& axis) {
  const MapPtr owned = with_axes("  axis: {point: " + axis + "}\n");
  EXPECT_EQ(owned->map().axes.size(), 1U);
  Positions found;
  for (const auto& [value, position] : owned->map().axes[0].positions) found.emplace_back(value, position);
  return found;
}

TEST(Axes, All_that_a_map_says_of_one_is_read) {
  const MapPtr owned =
      with_axes("  glue: {point: valve, joint: glue_joint, positions: {off: 0.25, on: 0.5}}\n");
  ASSERT_EQ(owned->map().axes.size(), 1U);
  const Axis& axis = owned->map().axes[0];
  EXPECT_EQ(axis.name, "glue");
  EXPECT_EQ(axis.point, "valve");
  EXPECT_EQ(axis.joint, "glue_joint");
  EXPECT_EQ(joint_name(owned->map(), axis), "glue_joint");
  EXPECT_EQ(positions_of("valve, positions: {off: 0.25, on: 0.5}"), (Positions{{0, 0.25}, {1, 0.5}}));
}

TEST(Axes, A_joint_without_a_name_has_that_of_the_map_and_of_the_axis) {
  const MapPtr owned = with_axes("  glue: {point: valve}\n");
  EXPECT_EQ(owned->map().axes[0].joint, "");
  EXPECT_EQ(joint_name(owned->map(), owned->map().axes[0]), "cell/glue");
}

TEST(Axes, A_BOOL_without_positions_is_off_at_0_and_on_at_1) {
  EXPECT_EQ(positions_of("valve"), (Positions{{0, 0}, {1, 1}}));
  EXPECT_EQ(positions_of("flag"), (Positions{{0, 0}, {1, 1}}));
}

TEST(Axes, A_number_without_positions_has_its_published_value_as_the_position) {
  for (const char* point : {"mode", "step", "nibble", "large", "level", "force", "mask"})
    EXPECT_EQ(positions_of(point), Positions{}) << point;
}

TEST(Axes, Positions_are_in_ascending_order) {
  EXPECT_EQ(positions_of("valve, positions: {off: 2, on: -1}"), (Positions{{1, -1}, {0, 2}}));
  EXPECT_EQ(positions_of("step, positions: {1: 0.5, 2: 0.25, 3: 0.75}"),
            (Positions{{2, 0.25}, {1, 0.5}, {3, 0.75}}));
}

TEST(Axes, The_values_of_a_BOOL_may_be_written_as_YAML_and_JSON_write_them) {
  const Positions expected{{0, 3}, {1, 4}};
  for (const char* keys : {"off: 3, on: 4", "\"off\": 3, \"on\": 4", "false: 3, true: 4", "'no': 3, YES: 4",
                           "0: 3, 1: 4", "\"0\": 3, \"1\": 4"})
    for (const char* point : {"valve", "flag"})
      EXPECT_EQ(positions_of(fmt::format("{}, positions: {{{}}}", point, keys)), expected) << keys;
}

TEST(Axes, The_values_of_an_integer_are_numbers_or_their_names) {
  EXPECT_EQ(positions_of("mode, positions: {back: -1.5, 0: 0, run: 1.5}"),
            (Positions{{-1, -1.5}, {0, 0}, {7, 1.5}}));
  EXPECT_EQ(positions_of("step, positions: {-128: 0, 0x7f: 1}"), (Positions{{-128, 0}, {127, 1}}));
  EXPECT_EQ(positions_of("nibble, positions: {0: 0, 15: 1}"), (Positions{{0, 0}, {15, 1}}));
  EXPECT_EQ(positions_of("large, positions: {0: 0, 9223372036854775807: 1}"),
            (Positions{{0, 0}, {9223372036854775807, 1}}));
  EXPECT_EQ(positions_of("mask, positions: {0: 0, 0x8000: 1}"), (Positions{{0, 0}, {32768, 1}}));
}

TEST(Axes, They_are_in_the_order_of_the_file) {
  const MapPtr owned = with_axes("  second: {point: valve}\n  first: {point: horn}\n");
  ASSERT_EQ(owned->map().axes.size(), 2U);
  EXPECT_EQ(owned->map().axes[0].name, "second");
  EXPECT_EQ(owned->map().axes[1].name, "first");
}

TEST(Axes, The_map_without_one_has_the_same_fingerprint) {
  EXPECT_EQ(with_axes("  glue: {point: valve}\n")->map().fingerprint,
            test::load_clean(std::string("name: cell\n") + points)->map().fingerprint);
}

TEST(Axes, May_stand_beside_tools_and_have_the_name_of_a_point) {
  const MapPtr owned = test::load_clean(
      std::string("name: cell\naxes: {valve: {point: valve}}\ntools: {clamp: {close: horn, travel: 1s}}\n") +
      points);
  EXPECT_EQ(owned->map().axes.size(), 1U);
  EXPECT_EQ(owned->map().tools.size(), 1U);
}

TEST(Axes, Those_of_a_served_map_are_read_too) {
  const LoadResult loaded = load_served_map(
      "{name: cell, axes: {glue: {point: valve, colour: red}}, mapping: {coils: {valve: 0}}}", "cell");
  ASSERT_TRUE(loaded.map) << "a node may be newer";
  EXPECT_EQ(loaded.map->map().axes.size(), 1U);
}

TEST(Axes, There_are_at_most_64) {
  const auto with = [](int count) {
    std::string axes;
    std::string coils;
    for (int i = 0; i < count; ++i) {
      axes += fmt::format("  a{0}: {{point: c{0}}}\n", i);
      coils += fmt::format("{}c{}: {}", i == 0 ? "" : ", ", i, i);
    }
    return load_map("name: cell\naxes:\n" + axes + "mapping: {coils: {" + coils + "}}\n", "cell");
  };
  EXPECT_TRUE(with(64).map);
  const LoadResult many = with(65);
  EXPECT_FALSE(many.map);
  ASSERT_EQ(many.diagnostics.size(), 1U);
  EXPECT_EQ(many.diagnostics[0].what, "there are 65 axes, and a map has at most 64");
}

}  // namespace
}  // namespace coupler
