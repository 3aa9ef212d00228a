// SPDX-License-Identifier: Apache-2.0
// `tools:`; what is refused has its maps in test/maps/bad.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include "coupler/map/joint.hpp"
#include "test/common/map/loader/loaded.hpp"

namespace coupler {
namespace {

using namespace std::chrono_literals;

constexpr const char* points =
    "mapping:\n"
    "  coils: {grip: 0, release: 1, suction: 2}\n"
    "  discrete_inputs: {gripped: 0, released: 1, part: 2}\n"
    "  holding_registers: {clamp: {address: 0, type: BOOL, bit: 3}}\n";

MapPtr with_tools(const std::string& tools) {
  return test::load_clean("name: cell\ntools:\n" + tools + points);
}

TEST(Tools, All_that_a_map_says_of_one_is_read) {
  const MapPtr owned = with_tools(
      "  gripper: {close: grip, open: release, closed: gripped, opened: released, holds: part, travel: "
      "300ms, "
      "timeout: 900ms, settle: 20ms, hold: false, empty: ok, direct: true, joint: finger_joint, "
      "positions: {open: 0.04, closed: 0.01}, on_cancel: open}\n");
  ASSERT_EQ(owned->map().tools.size(), 1U);
  const Tool& tool = owned->map().tools[0];
  EXPECT_EQ(tool.name, "gripper");
  EXPECT_EQ(tool.close, "grip");
  EXPECT_EQ(tool.open, "release");
  EXPECT_EQ(tool.closed, "gripped");
  EXPECT_EQ(tool.opened, "released");
  EXPECT_EQ(tool.holds, "part");
  EXPECT_EQ(tool.travel, 300ms);
  EXPECT_EQ(tool.timeout, 900ms);
  EXPECT_EQ(tool.settle, 20ms);
  EXPECT_FALSE(tool.hold);
  EXPECT_EQ(tool.empty, OnEmpty::ok);
  EXPECT_TRUE(tool.direct);
  EXPECT_EQ(tool.joint, "finger_joint");
  EXPECT_EQ(joint_name(owned->map(), tool), "finger_joint");
  EXPECT_EQ(tool.positions.open, 0.04);
  EXPECT_EQ(tool.positions.closed, 0.01);
  EXPECT_EQ(tool.on_cancel, OnCancel::open);
}

TEST(Tools, What_the_map_does_not_say_of_one_has_its_default) {
  const MapPtr owned = with_tools("  cup: {close: suction, travel: 2s}\n");
  ASSERT_EQ(owned->map().tools.size(), 1U);
  const Tool& tool = owned->map().tools[0];
  EXPECT_EQ(tool.open, "");
  EXPECT_EQ(tool.closed, "");
  EXPECT_EQ(tool.opened, "");
  EXPECT_EQ(tool.holds, "");
  EXPECT_EQ(tool.timeout, 2s);
  EXPECT_EQ(tool.settle, 0ms);
  EXPECT_TRUE(tool.hold);
  EXPECT_EQ(tool.empty, OnEmpty::abort);
  EXPECT_FALSE(tool.direct);
  EXPECT_EQ(joint_name(owned->map(), tool), "cell/cup");
  EXPECT_EQ(tool.positions, JointPositions{});
  EXPECT_EQ(tool.on_cancel, OnCancel::stay);
  EXPECT_EQ(owned->map().joint_rate, 10);
}

TEST(Tools, A_position_that_is_not_given_has_its_default) {
  const MapPtr owned = with_tools("  cup: {close: suction, travel: 2s, positions: {open: 0.04}}\n");
  EXPECT_EQ(owned->map().tools[0].positions, (JointPositions{0.04, 0}));
}

TEST(Tools, On_cancel_may_be_open_or_close_with_any_outputs) {
  with_tools("  cup: {close: suction, travel: 1s, on_cancel: open}\n");
  with_tools("  cup: {close: suction, travel: 1s, on_cancel: close}\n");
}

TEST(Tools, Joint_rate_is_read_and_is_allowed_without_tools) {
  EXPECT_EQ(test::load_clean(std::string("name: cell\njoint_rate: 2.5\n") + points)->map().joint_rate, 2.5);
}

TEST(Tools, They_are_in_the_order_of_the_file) {
  const MapPtr owned = with_tools(
      "  second: {close: suction, travel: 1s}\n  first: {open: release, closed: gripped, opened: "
      "released}\n");
  ASSERT_EQ(owned->map().tools.size(), 2U);
  EXPECT_EQ(owned->map().tools[0].name, "second");
  EXPECT_EQ(owned->map().tools[1].name, "first");
}

TEST(Tools, A_bit_of_a_holding_register_may_drive_one_and_any_bit_that_is_read_may_be_its_sensor) {
  with_tools("  vise: {close: clamp, closed: suction, opened: released}\n");
}

TEST(Tools, Two_may_have_a_sensor_in_common) {
  with_tools("  a: {close: grip, holds: part, travel: 1s}\n  b: {close: release, holds: part, travel: 1s}\n");
}

TEST(Tools, One_may_have_the_name_of_a_point_or_of_a_topic_of_the_driver) {
  with_tools("  clamp: {close: grip, travel: 1s}\n  status: {close: release, travel: 1s}\n");
}

TEST(Tools, The_map_without_one_has_the_same_fingerprint) {
  EXPECT_EQ(with_tools("  cup: {close: suction, travel: 1s}\n")->map().fingerprint,
            test::load_clean(std::string("name: cell\n") + points)->map().fingerprint);
}

TEST(Tools, Are_found_by_their_outputs) {
  const MapPtr owned = with_tools(
      "  gripper: {close: grip, open: release, travel: 1s}\n"
      "  cup: {close: suction, holds: part, travel: 1s, direct: true}\n");
  const Tool* tool = tool_with_output(owned->map(), "release");
  ASSERT_NE(tool, nullptr);
  EXPECT_EQ(tool->name, "gripper");
  EXPECT_EQ(tool_with_output(owned->map(), "part"), nullptr);
}

TEST(Tools, Those_of_a_served_map_are_read_too) {
  const LoadResult loaded = load_served_map(
      "{name: cell, tools: {cup: {close: suction, travel: 1s, colour: red}}, mapping: {coils: {suction: 0}}}",
      "cell");
  ASSERT_TRUE(loaded.map) << "a node may be newer";
  EXPECT_EQ(loaded.map->map().tools.size(), 1U);
}

TEST(Tools, There_are_at_most_64) {
  const auto with = [](int count) {
    std::string tools;
    std::string coils;
    for (int i = 0; i < count; ++i) {
      tools += fmt::format("  t{0}: {{close: c{0}, travel: 1s}}\n", i);
      coils += fmt::format("{}c{}: {}", i == 0 ? "" : ", ", i, i);
    }
    return load_map("name: cell\ntools:\n" + tools + "mapping: {coils: {" + coils + "}}\n", "cell");
  };
  EXPECT_TRUE(with(64).map);
  const LoadResult many = with(65);
  EXPECT_FALSE(many.map);
  ASSERT_EQ(many.diagnostics.size(), 1U);
  EXPECT_EQ(many.diagnostics[0].what, "there are 65 tools, and a map has at most 64");
}

}  // namespace
}  // namespace coupler
