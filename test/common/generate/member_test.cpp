// SPDX-License-Identifier: Apache-2.0
#include "coupler/generate/member.hpp"

#include <gmock/gmock.h>

#include "coupler/generate/macros.hpp"
#include "test/fakes/map_builder.hpp"

namespace coupler::generate {
namespace {

using codec::Type;
using ::testing::ElementsAre;

TEST(Member, A_name_that_cannot_be_a_member_gets_one_that_can) {
  const MapPtr map = fakes::MapBuilder()
                         .add(Table::coils, "arm/left", 0, Type::BOOL)
                         .add(Table::coils, "arm_left", 1, Type::BOOL)
                         .add(Table::coils, "register", 2, Type::BOOL)
                         .add(Table::coils, "online", 3, Type::BOOL)
                         .add(Table::coils, "online_", 4, Type::BOOL)
                         .build();
  // What is a name already stays one, wherever it stands: code that uses it goes on meaning that point.
  EXPECT_THAT(members(map->map()), ElementsAre("arm_left_", "arm_left", "register_", "online__", "online_"));
}

TEST(Member, A_name_in_capital_letters_stays_and_macros_of_that_name_are_put_aside) {
  const MapPtr map = fakes::MapBuilder()
                         .add(Table::coils, "PUMP", 0, Type::BOOL)
                         .add(Table::coils, "EAGAIN", 1, Type::BOOL)
                         .add(Table::coils, "errno", 2, Type::BOOL)
                         .build();
  EXPECT_THAT(members(map->map()), ElementsAre("PUMP", "EAGAIN", "errno_"));
  const WithoutMacros lines = without_macros({"PUMP", "door", "EAGAIN", "PUMP"});
  EXPECT_EQ(
      lines.before,
      "\n// Macros of other headers may have these names. They are put aside here, and are back below.\n"
      "#pragma push_macro(\"EAGAIN\")\n#undef EAGAIN\n#pragma push_macro(\"PUMP\")\n#undef PUMP\n");
  EXPECT_EQ(lines.after, "\n#pragma pop_macro(\"EAGAIN\")\n#pragma pop_macro(\"PUMP\")\n");
}

TEST(Member, Names_as_most_are_cost_no_line) {
  for (const char* name : {"pump", "left_arm_2", "Pump", "PumpOn", "sign", "state", "hall"})
    EXPECT_FALSE(could_be_macro(name)) << name;
  for (const char* name : {"I", "K1", "NaN", "PRIx64", "E2BIG", "T_ROOM", "si_pid", "linux"})
    EXPECT_TRUE(could_be_macro(name)) << name;
  EXPECT_EQ(without_macros({"pump", "Pump"}).before, "");
  EXPECT_EQ(without_macros({"pump", "Pump"}).after, "");
}

TEST(Member, The_type_is_that_of_the_value) {
  Point point;
  point.format.type = Type::CHAR;
  EXPECT_EQ(cpp_type(point), "::std::uint8_t");
  point.format.type = Type::DWORD;
  EXPECT_EQ(cpp_type(point), "::std::uint32_t");
  point.count = 3;
  EXPECT_EQ(cpp_type(point), "::std::array<::std::uint32_t, 3>");
  point.format.type = Type::INT;
  point.scale.gain = 0.1;
  EXPECT_EQ(cpp_type(point), "::std::array<double, 3>");
}

TEST(Member, The_documentation_has_range_units_and_place_and_stays_one_line) {
  Point point;
  point.table = Table::holding_registers;
  point.address = 7;
  point.format.type = Type::INT;
  point.scale.gain = 0.1;
  point.units = "°C";
  point.description = "Of the oil\nin the pan \\";
  EXPECT_EQ(documentation(point), "Of the oil in the pan \\: INT, -3276.8 … 3276.7 °C; holding_registers 7.");
}

}  // namespace
}  // namespace coupler::generate
