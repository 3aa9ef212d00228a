// SPDX-License-Identifier: Apache-2.0
#include "coupler/docs/document.hpp"

#include <gmock/gmock.h>

#include <sstream>

#include "test/common/docs/hostile.hpp"

namespace coupler::docs {
namespace {

using testing::HasSubstr;
using testing::Not;

/// Bars that part cells.
std::size_t bars(const std::string& line) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '\\')
      ++i;
    else if (line[i] == '|')
      ++count;
  }
  return count;
}

/// Every line of a table has as many bars as the table's first. Returns how many such lines there are.
std::size_t check_tables(const std::string& page) {
  std::istringstream lines(page);
  std::size_t expected = 0;  // 0: outside of a table
  std::size_t rows = 0;
  for (std::string line; std::getline(lines, line);) {
    const bool inside = line.rfind('|', 0) == 0;
    if (inside && expected == 0) expected = bars(line);
    if (!inside) expected = 0;
    EXPECT_EQ(inside ? bars(line) : 0, expected) << line;
    rows += inside ? 1U : 0U;
  }
  return rows;
}

TEST(Markdown, No_text_of_a_map_becomes_more_than_a_text) {
  const std::string page = markdown_page(test::hostile_document());
  const std::string before_code = page.substr(0, page.find("```"));
  EXPECT_THAT(before_code, Not(HasSubstr("<script")));
  EXPECT_THAT(page, Not(HasSubstr("\nnext"))) << "a text began a line";
  EXPECT_GT(check_tables(before_code), 20U);
}

TEST(Markdown, A_text_cannot_end_the_block_of_commands) {
  const std::string page = markdown_page(test::hostile_document());
  std::istringstream lines(page);
  std::size_t fences = 0;
  for (std::string line; std::getline(lines, line);) fences += line.rfind("```", 0) == 0 ? 1U : 0U;
  EXPECT_EQ(fences, 8U) << "two drawings, two blocks of commands";
}

TEST(Markdown, Each_address_space_has_a_table_of_its_points) {
  auto builder = fakes::MapBuilder("cell").many(Table::coils, 0, 2);
  builder.add(Table::holding_registers, "level", 6, codec::Type::REAL, [](Point& p) { p.units = "m|s"; });
  const auto map = builder.build();
  const std::vector<int> lines{3, 4, 6};
  const std::string page =
      markdown_page(make_document(map->map(), lines, {"cell.yaml", "cell.yaml", "1.2.3"}));
  EXPECT_THAT(page, HasSubstr("\n## Coils (2)\n"));
  EXPECT_THAT(page, HasSubstr("\n## Discrete inputs (0)\n"));
  EXPECT_THAT(
      page,
      HasSubstr(
          "| [`level`](<cell.yaml#L6>) | 6&nbsp;–&nbsp;7 | 40007&nbsp;–&nbsp;40008 | REAL | ABCD | m\\|s | "
          "read, write | `std_msgs/Float32` |\n"));
}

TEST(Markdown, Tools_have_a_table_if_there_are_any) {
  auto builder = fakes::MapBuilder("cell").coil("grip", 0).coil("release", 1).input("part", 0);
  EXPECT_THAT(markdown_page(make_document(builder.build()->map(), {}, {"cell.yaml", "", "1.2.3"})),
              Not(HasSubstr("Tools")));
  Tool gripper;
  gripper.name = "gripper";
  gripper.close = "grip";
  gripper.open = "release";
  gripper.holds = "part";
  gripper.travel = std::chrono::milliseconds(300);
  gripper.settle = std::chrono::milliseconds(20);
  builder.head().tools = {&gripper, 1};
  EXPECT_THAT(
      markdown_page(make_document(builder.build()->map(), {}, {"cell.yaml", "", "1.2.3"})),
      HasSubstr("\n## Tools (1)\n\n"
                "| tool | closes by | opens by | closed | open | holds a part | without a part | stuck |\n"
                "|---|---|---|---|---|---|---|---|\n"
                "| gripper | grip on | release on | after 300 ms | after 300 ms | part on for 20 ms | "
                "fails | after 2 s |\n"));
  gripper.on_cancel = OnCancel::open;
  gripper.positions.open = 0.04;
  EXPECT_THAT(markdown_page(make_document(builder.build()->map(), {}, {"cell.yaml", "", "1.2.3"})),
              HasSubstr("| after 2 s | opens | cell/gripper\\: open 0.04, closed 0 |\n"));
}

TEST(Markdown, Axes_have_a_table_if_there_are_any) {
  auto builder = fakes::MapBuilder("cell").coil("valve", 0);
  builder.add(Table::holding_registers, "speed", 0, codec::Type::INT);
  EXPECT_THAT(markdown_page(make_document(builder.build()->map(), {}, {"cell.yaml", "", "1.2.3"})),
              Not(HasSubstr("Axes")));
  const AxisPosition positions[] = {{1, -0.5}, {0, 0}};
  const Axis axes[] = {{"glue", "valve", "glue_joint", positions}, {"belt", "speed"}};
  builder.head().axes = axes;
  EXPECT_THAT(markdown_page(make_document(builder.build()->map(), {}, {"cell.yaml", "", "1.2.3"})),
              HasSubstr("\n## Axes (2)\n\n"
                        "| axis | point | joint | positions |\n"
                        "|---|---|---|---|\n"
                        "| glue | valve | glue\\_joint | on at -0.5, off at 0 |\n"
                        "| belt | speed | cell/belt | the published value |\n"));
}

}  // namespace
}  // namespace coupler::docs
