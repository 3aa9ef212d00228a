// SPDX-License-Identifier: Apache-2.0
#include "coupler/map/plain_value.hpp"

#include <gmock/gmock.h>

namespace coupler {
namespace {

using ::testing::ElementsAre;

Point tenths(std::uint16_t count) {
  Point point;
  point.table = Table::holding_registers;
  point.format.type = codec::Type::INT;
  point.count = count;
  point.scale.gain = 0.1;
  return point;
}

TEST(PlainValue, An_array_is_written_as_a_whole_or_not_at_all) {
  std::uint16_t registers[] = {1, 2, 3};
  using Values = PlainValue<std::array<double, 3>>;
  EXPECT_FALSE(Values::encode({0.5, 1e9, 0.7}, tenths(3), registers));
  EXPECT_THAT(registers, ElementsAre(1, 2, 3));
  EXPECT_TRUE(Values::encode({0.5, -0.1, 0.7}, tenths(3), registers));
  EXPECT_THAT(registers, ElementsAre(5, 0xFFFF, 7));
  EXPECT_THAT(Values::decode(registers, tenths(3)), ElementsAre(0.5, -0.1, 7 * 0.1));
}

TEST(PlainValue, A_bit_of_a_register_leaves_its_neighbours_alone) {
  Point point;
  point.table = Table::holding_registers;
  point.format.type = codec::Type::BOOL;
  point.format.bit = 3;
  std::uint16_t registers[] = {0xA5A5};
  EXPECT_TRUE(PlainValue<bool>::encode(true, point, registers));
  EXPECT_EQ(registers[0], 0xA5AD);
  EXPECT_TRUE(PlainValue<bool>::decode(registers, point));
}

TEST(PlainValue, A_text_is_UTF_8_whatever_its_encoding) {
  Point point;
  point.table = Table::holding_registers;
  point.format.type = codec::Type::STRING;
  point.format.length = 4;
  point.format.encoding = codec::Encoding::latin1;
  std::uint16_t registers[2] = {};
  using Value = PlainValue<Text<8>>;
  EXPECT_TRUE(Value::encode("Tür", point, registers));
  EXPECT_EQ(std::string_view(Value::decode(registers, point)), "Tür");
  EXPECT_FALSE(Value::encode("Türen", point, registers)) << "five bytes";
  EXPECT_EQ(std::string_view(Value::decode(registers, point)), "Tür");
}

}  // namespace
}  // namespace coupler
