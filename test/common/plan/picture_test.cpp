// SPDX-License-Identifier: Apache-2.0
#include "coupler/plan/picture.hpp"

#include <gmock/gmock.h>

#include "coupler/plan/picture_layout.hpp"
#include "test/common/plan/tables.hpp"
#include "test/fakes/map_builder.hpp"

namespace coupler::plan {
namespace {

using fakes::MapBuilder;
using modbus::Range;
using testing::HasSubstr;
using testing::Not;

std::string drawn(MapBuilder builder) {
  const auto owned = builder.build();
  return picture(owned->map(), make_read_plan(owned->map()));
}

TEST(TableLayout, Rows_in_which_nothing_is_are_left_out) {
  const TableLayout layout({Range::of(3, 2), Range::of(100, 1)}, large, 50);
  ASSERT_EQ(layout.rows().size(), 2U);
  EXPECT_EQ(layout.rows()[1].first, 96U);
  EXPECT_FALSE(layout.rows()[0].after_skip);
  EXPECT_TRUE(layout.rows()[1].after_skip);
  EXPECT_TRUE(layout.boxes(Range::of(40, 1)).empty());
}

TEST(TableLayout, A_range_has_a_box_in_each_row) {
  const TableLayout layout({Range::of(0, 64)}, large, 0);
  const auto boxes = layout.boxes(Range::of(14, 20));
  ASSERT_EQ(boxes.size(), 3U);
  EXPECT_EQ(boxes[0].x, TableLayout::left + 14 * large.cell);
  EXPECT_EQ(boxes[0].width, 2 * large.cell);
  EXPECT_EQ(boxes[1].width, 16 * large.cell);
  EXPECT_EQ(boxes[2].y, 2 * large.height);
  EXPECT_EQ(boxes[2].width, 2 * large.cell);
}

TEST(TableLayout, The_last_address_of_a_table_has_its_place) {
  const TableLayout layout({Range::of(65535, 1)}, small, 0);
  ASSERT_EQ(layout.boxes(Range::of(65535, 1)).size(), 1U);
}

TEST(Picture, It_shows_points_requests_and_holes) {
  auto builder = MapBuilder().many(hr, 0, 1).many(hr, 3, 1).many(Table::coils, 9, 1);
  builder.head().polling.register_continuous = true;
  const std::string svg = drawn(builder);
  EXPECT_THAT(svg, HasSubstr("<title>holding_registers_3: WORD, 3 to 3, 10 Hz</title>"));
  EXPECT_THAT(svg, HasSubstr("<title>request: holding registers 0 to 3 (2 points) at 10 Hz; ends: "));
  EXPECT_THAT(svg, HasSubstr("<title>1 to 2: read, for no point</title>"));
  EXPECT_THAT(svg, Not(HasSubstr("discrete inputs"))) << "a table without points";
}

TEST(Picture, On_request_it_shows_every_table_and_links_the_points) {
  const auto owned = MapBuilder().many(hr, 0, 2).build();
  const std::string svg = picture(owned->map(), make_read_plan(owned->map()), {true, "#point-"});
  EXPECT_THAT(svg, HasSubstr(">discrete inputs<"));
  EXPECT_THAT(svg, HasSubstr(">no points<"));
  EXPECT_THAT(svg, HasSubstr("<a href=\"#point-holding_registers_1\">"));
  EXPECT_THAT(drawn(MapBuilder().many(hr, 0, 2)), Not(HasSubstr("<a ")));
}

TEST(Picture, What_is_not_read_is_shown_as_such) {
  static const TableRange area[] = {{hr, Range::of(3, 2)}};
  auto builder = MapBuilder().many(hr, 0, 1).add(hr, "command", 1, codec::Type::UINT,
                                                 [](Point& point) { point.access = Access::write; });
  builder.head().unreadable = area;
  EXPECT_THAT(drawn(builder), HasSubstr("<title>command: UINT, 1 to 1, not read: write_only</title>"));
  EXPECT_THAT(drawn(builder), HasSubstr("<title>unreadable: 3 to 4</title>"));
}

TEST(Picture, Text_of_the_map_cannot_break_out_of_it) {
  auto builder = MapBuilder();
  builder.add(hr, "a", 0, codec::Type::UINT, [](Point& point) { point.description = "</title><script>\"&"; });
  EXPECT_THAT(drawn(builder), HasSubstr("&lt;/title&gt;&lt;script&gt;&quot;&amp;"));
}

TEST(Picture, Of_many_points_the_names_are_in_tooltips_only) {
  EXPECT_THAT(drawn(MapBuilder().many(hr, 0, 20)), HasSubstr("class=\"name\""));
  EXPECT_THAT(drawn(MapBuilder().many(hr, 0, 700)), Not(HasSubstr("class=\"name\"")));
}

}  // namespace
}  // namespace coupler::plan
