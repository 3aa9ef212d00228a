// SPDX-License-Identifier: Apache-2.0
// The bytes of 123.456 are those of Python's struct.
#include "coupler/docs/drawing.hpp"

#include <gmock/gmock.h>

#include "test/fakes/map_builder.hpp"

namespace coupler::docs {
namespace {

using codec::Order;
using codec::Type;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr Table holding = Table::holding_registers;

/// "C=E9 D=79 | A=42 B=F6", registers apart.
std::string cells(const Drawing& drawing) {
  std::string text;
  for (const auto& drawn : drawing.registers) {
    text += text.empty() ? "" : " |";
    for (const auto& cell : drawn.cells) text += (text.empty() ? "" : " ") + cell.label + "=" + cell.content;
  }
  return text;
}

Drawing drawing_of(Type type, Order order) {
  auto builder = fakes::MapBuilder();
  builder.add(holding, "level", 6, type, [&](Point& point) {
    point.format.order = order;
    if (type == Type::STRING) point.format.length = 3;
  });
  const auto map = builder.build();
  return drawings_of(map->map()).at(0);
}

TEST(Drawing, Each_byte_of_a_value_stands_where_its_order_puts_it) {
  EXPECT_EQ(cells(drawing_of(Type::REAL, Order::ABCD)), "A=42 B=F6 | C=E9 D=79");
  EXPECT_EQ(cells(drawing_of(Type::REAL, Order::CDAB)), "C=E9 D=79 | A=42 B=F6");
  EXPECT_EQ(cells(drawing_of(Type::REAL, Order::BADC)), "B=F6 A=42 | D=79 C=E9");
  EXPECT_EQ(cells(drawing_of(Type::REAL, Order::DCBA)), "D=79 C=E9 | B=F6 A=42");
  EXPECT_EQ(cells(drawing_of(Type::UINT, Order::BADC)), "B=34 A=12");
  EXPECT_EQ(cells(drawing_of(Type::LREAL, Order::CDAB)), "G=BE H=77 | E=1A F=9F | C=DD D=2F | A=40 B=5E");
  EXPECT_EQ(drawing_of(Type::REAL, Order::CDAB).title, "level: REAL, order CDAB");
  EXPECT_EQ(drawing_of(Type::REAL, Order::CDAB).explanation,
            "The value 123.456 is 0x42F6E979; A is its most significant byte, D its least.");
  EXPECT_EQ(drawing_of(Type::WORD, Order::ABCD).explanation,
            "The value is 0x1234; A is its most significant byte, B its least.");
}

TEST(Drawing, The_characters_of_a_text_are_counted) {
  EXPECT_EQ(cells(drawing_of(Type::STRING, Order::ABCD)), "1=F 2=L | 3=O =00");
  EXPECT_EQ(cells(drawing_of(Type::STRING, Order::BADC)), "2=L 1=F | =00 3=O");
}

TEST(Drawing, Bits_are_those_of_one_register_and_numbered_as_the_map_does) {
  auto builder = fakes::MapBuilder();
  for (const int bit : {3, 12})
    builder.add(holding, bit == 3 ? "fault" : "ready", 6, Type::BOOL,
                [&](Point& point) { point.format.bit = static_cast<std::uint8_t>(bit); });
  builder.add(holding, "other", 7, Type::BOOL);
  const auto map = builder.build();
  const auto drawings = drawings_of(map->map());
  ASSERT_EQ(drawings.size(), 1U);
  EXPECT_EQ(cells(drawings[0]), "15=0 14=0 13=0 12=0 11=0 10=0 9=0 8=0 7=0 6=0 5=0 4=0 3=1 2=0 1=0 0=0");
  EXPECT_EQ(drawings[0].explanation,
            "The register is 0x0008 when fault is on and nothing else is. In it: bit 12 ready, bit 3 fault.");
}

TEST(Drawing, Bits_of_a_register_whose_low_byte_comes_first_are_numbered_behind_the_swap) {
  const Drawing drawing = drawing_of(Type::BOOL, Order::BADC);
  EXPECT_EQ(cells(drawing), "7=0 6=0 5=0 4=0 3=0 2=0 1=0 0=1 15=0 14=0 13=0 12=0 11=0 10=0 9=0 8=0");
  EXPECT_THAT(drawing.explanation, HasSubstr("0x0100"));
}

TEST(Drawing, Bytes_of_a_register_say_whose_they_are) {
  auto builder = fakes::MapBuilder();
  builder.add(holding, "right", 6, Type::USINT, [](Point& point) { point.format.half = codec::Half::low; });
  builder.add(holding, "left", 6, Type::BYTE);
  const auto map = builder.build();
  const auto drawings = drawings_of(map->map());
  ASSERT_EQ(drawings.size(), 1U);
  EXPECT_EQ(cells(drawings[0]), "high=12 low=00");
  EXPECT_THAT(drawings[0].explanation, HasSubstr("In it: high byte left, low byte right."));
}

TEST(Drawing, There_is_one_for_each_order_that_the_map_uses_and_none_for_coils) {
  EXPECT_THAT(drawings_of(fakes::MapBuilder().many(Table::coils, 0, 2).build()->map()), IsEmpty());
  auto builder = fakes::MapBuilder();
  builder.add(holding, "a", 0, Type::REAL).add(holding, "b", 2, Type::UDINT).add(holding, "c", 4, Type::INT);
  builder.add(Table::input_registers, "d", 0, Type::REAL,
              [](Point& point) { point.format.order = Order::CDAB; });
  const auto map = builder.build();
  std::vector<std::string> titles;
  for (const Drawing& drawing : drawings_of(map->map())) titles.push_back(drawing.title);
  EXPECT_THAT(titles, ElementsAre("d: REAL, order CDAB", "a: REAL, order ABCD", "c: INT, order AB"));
}

TEST(Drawing, As_text_its_registers_stand_side_by_side) {
  EXPECT_EQ(as_text(drawing_of(Type::REAL, Order::CDAB)),
            "register          6                  7\n"
            "          +-------+-------+  +-------+-------+\n"
            "which     |   C   |   D   |  |   A   |   B   |\n"
            "holds     |  E9   |  79   |  |  42   |  F6   |\n"
            "          +-------+-------+  +-------+-------+\n");
}

TEST(Drawing, As_a_picture_it_can_be_heard) {
  EXPECT_THAT(as_svg(drawing_of(Type::REAL, Order::CDAB)),
              HasSubstr("aria-label=\"register 6: C E9 D 79; register 7: A 42 B F6\""));
}

}  // namespace
}  // namespace coupler::docs
