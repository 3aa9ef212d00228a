// SPDX-License-Identifier: Apache-2.0
#include "coupler/docs/document.hpp"

#include <gmock/gmock.h>

#include "test/common/docs/hostile.hpp"

namespace coupler::docs {
namespace {

using testing::HasSubstr;
using testing::Not;

std::size_t count_of(const std::string& text, std::string_view what) {
  std::size_t count = 0;
  for (auto at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++count;
  return count;
}

Document of(fakes::MapBuilder builder, std::string url = "cell.yaml") {
  const auto map = builder.build();
  const std::vector<int> lines(map->map().points.size(), 12);
  return make_document(map->map(), lines, {"cell.yaml", std::move(url), "1.2.3"});
}

TEST(Html, No_text_of_a_map_becomes_more_than_a_text) {
  const std::string page = html_page(test::hostile_document());
  EXPECT_EQ(count_of(page, "<script"), 2U) << "the page's own";
  EXPECT_EQ(count_of(page, "</script"), 2U);
  EXPECT_THAT(page, HasSubstr("&lt;script&gt;alert(1)&lt;/script&gt; | `x` --&gt; &quot;q&quot; next"));
}

TEST(Html, A_page_needs_nothing_from_elsewhere) {
  const std::string page = html_page(of(fakes::MapBuilder().many(Table::coils, 0, 3)));
  EXPECT_THAT(page, Not(HasSubstr(" src=")));
  EXPECT_THAT(page, Not(HasSubstr("@import")));
  EXPECT_THAT(page, Not(HasSubstr("url(http")));
  EXPECT_THAT(page, HasSubstr("default-src 'none'"));
}

TEST(Html, Every_point_is_a_row_that_the_picture_links_to) {
  const std::string page = html_page(of(fakes::MapBuilder().many(Table::input_registers, 0, 3)));
  for (const auto* name : {"input_registers_0", "input_registers_1", "input_registers_2"}) {
    EXPECT_EQ(count_of(page, std::string("<tr id=\"point-") + name + "\""), 1U);
    EXPECT_EQ(count_of(page, std::string("href=\"#point-") + name + "\""), 2U)
        << "in its row and in the picture";
  }
  EXPECT_THAT(page, HasSubstr(">no points<")) << "the other spaces are in the picture too";
}

TEST(Html, A_row_links_to_its_line_of_the_map) {
  const auto points = fakes::MapBuilder().many(Table::coils, 0, 1);
  EXPECT_THAT(html_page(of(points)), HasSubstr("<a href=\"cell.yaml#L12\">L12</a>"));
  EXPECT_THAT(html_page(of(points, "https://forge/x?a=1&b=2")),
              HasSubstr("<a href=\"https://forge/x?a=1&amp;b=2#L12\""));
  EXPECT_THAT(html_page(of(points, "")), Not(HasSubstr("#L12")));
}

TEST(Html, Columns_that_no_point_fills_are_left_out) {
  EXPECT_THAT(html_page(of(fakes::MapBuilder().many(Table::coils, 0, 1))), Not(HasSubstr(">Units</th>")));
  auto builder = fakes::MapBuilder();
  builder.add(Table::coils, "a", 0, codec::Type::BOOL, [](Point& point) { point.units = "bar"; });
  EXPECT_THAT(html_page(of(builder)), HasSubstr(">Units</th>"));
}

TEST(Html, Tools_have_a_section_if_there_are_any) {
  auto builder = fakes::MapBuilder().coil("suction", 0).input("vacuum", 0);
  EXPECT_THAT(html_page(of(builder)), Not(HasSubstr("#tools")));
  Tool cup;
  cup.name = "cup";
  cup.close = "suction";
  cup.closed = "vacuum";
  cup.travel = std::chrono::milliseconds(300);
  builder.head().tools = {&cup, 1};
  const std::string page = html_page(of(builder));
  EXPECT_THAT(page, HasSubstr("<a href=\"#tools\">Tools</a>"));
  EXPECT_THAT(page, HasSubstr("<h3>cup</h3>\n<dl>\n<dt>Closes by</dt><dd>suction on</dd>\n"
                              "<dt>Opens by</dt><dd>suction off</dd>\n<dt>Closed</dt><dd>vacuum on</dd>\n"
                              "<dt>Open</dt><dd>after 300 ms</dd>\n<dt>Stuck</dt><dd>after 2 s</dd>\n</dl>"));
  EXPECT_THAT(page, HasSubstr("rosservice call /device/cup/close"));
  EXPECT_THAT(page, Not(HasSubstr("suction/write"))) << "only the tool writes it";
}

TEST(Html, All_joints_are_shown_if_the_map_sets_joint_or_positions_of_one_tool) {
  auto builder = fakes::MapBuilder().coil("suction", 0).coil("valve", 1);
  Tool tools[2];
  tools[0].name = "cup";
  tools[0].close = "suction";
  tools[1].name = "clamp";
  tools[1].close = "valve";
  builder.head().tools = tools;
  EXPECT_THAT(html_page(of(builder)), Not(HasSubstr("Joint")));
  tools[0].joint = "finger";
  EXPECT_THAT(html_page(of(builder)),
              AllOf(HasSubstr("<dt>Joint</dt><dd>finger: open 1, closed 0</dd>"),
                    HasSubstr("<dt>Joint</dt><dd>device/clamp: open 1, closed 0</dd>")));
}

TEST(Html, Axes_have_a_section_if_there_are_any) {
  auto builder = fakes::MapBuilder();
  builder.add(Table::holding_registers, "speed", 0, codec::Type::INT, [](Point& point) {
    static constexpr NamedValue values[] = {{0, "idle"}, {3, "fast"}};
    point.values = values;
  });
  EXPECT_THAT(html_page(of(builder)), Not(HasSubstr("#axes")));
  const AxisPosition positions[] = {{0, 0}, {3, 1.5}};
  const Axis belt{"belt", "speed", {}, positions};
  builder.head().axes = {&belt, 1};
  const std::string page = html_page(of(builder));
  EXPECT_THAT(page, HasSubstr("<a href=\"#axes\">Axes</a>"));
  EXPECT_THAT(page, HasSubstr("<section id=\"axes\">\n<h2>Axes</h2>\n<div class=\"groups\">\n"
                              "<div><h3>belt</h3>\n<dl>\n<dt>Point</dt><dd>speed</dd>\n"
                              "<dt>Joint</dt><dd>device/belt</dd>\n"
                              "<dt>Positions</dt><dd>idle at 0, fast at 1.5</dd>\n</dl>"));
}

TEST(Html, A_map_without_points_has_a_page) {
  EXPECT_THAT(html_page(of(fakes::MapBuilder())), HasSubstr("<table id=\"points\">"));
}

}  // namespace
}  // namespace coupler::docs
