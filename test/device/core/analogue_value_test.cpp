// SPDX-License-Identifier: Apache-2.0
#include "device/core/analogue_value.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

namespace coupler::node {
namespace {

using codec::Type;
using Registers = std::array<std::uint16_t, 4>;

Point point_of(Type type, codec::Scale scale = {}) {
  Point point;
  point.table = Table::input_registers;
  point.format.type = type;
  point.scale = scale;
  return point;
}

Registers put(double value, const Point& point, Registers before = {}) {
  put_value(value, point, before.data());
  return before;
}

TEST(AnalogueValue, Is_raw_times_gain_plus_offset) {
  const Registers registers{250};
  EXPECT_DOUBLE_EQ(15, value_in(point_of(Type::UINT, {0.1, -10}), registers.data()));
}

TEST(AnalogueValue, Is_rounded_to_the_nearest_raw_value) {
  EXPECT_EQ(3U, put(2.5, point_of(Type::UINT))[0]);
  EXPECT_EQ(2U, put(2.49, point_of(Type::UINT))[0]);
  EXPECT_EQ(0xFFFD, put(-2.5, point_of(Type::INT))[0]);
  EXPECT_EQ(253U, put(15.3, point_of(Type::UINT, {0.1, -10}))[0]);
}

TEST(AnalogueValue, Beyond_the_type_is_the_type_s_last_value) {
  EXPECT_EQ(0U, put(-1, point_of(Type::UINT))[0]);
  EXPECT_EQ(0xFFFF, put(1e9, point_of(Type::UINT))[0]);
  EXPECT_EQ(0x8000, put(-1e9, point_of(Type::INT))[0]);
  EXPECT_EQ((Registers{0x7FFF, 0xFFFF, 0xFFFF, 0xFFFF}), put(1e30, point_of(Type::LINT)));
  EXPECT_EQ((Registers{0xFFFF, 0xFFFF, 0xFFFF, 0xFFFF}), put(1e30, point_of(Type::ULINT)));
  EXPECT_EQ((Registers{0x7F7F, 0xFFFF}), put(1e300, point_of(Type::REAL)));
}

TEST(AnalogueValue, Stands_in_its_registers_in_the_point_s_order) {
  Point point = point_of(Type::REAL);
  EXPECT_EQ((Registers{0x4148, 0}), put(12.5, point));
  point.format.order = codec::Order::CDAB;
  EXPECT_EQ((Registers{0, 0x4148}), put(12.5, point));
  EXPECT_DOUBLE_EQ(12.5, value_in(point, put(12.5, point).data()));
}

TEST(AnalogueValue, Of_a_byte_leaves_the_other_byte_alone) {
  Point point = point_of(Type::SINT);
  point.format.half = codec::Half::low;
  EXPECT_EQ(0xAB80, put(-300, point, {0xABCD})[0]);
  EXPECT_DOUBLE_EQ(-1, value_in(point, Registers{0xABFF}.data()));
}

TEST(AnalogueValue, That_is_not_a_number_is_told) {
  EXPECT_TRUE(std::isnan(value_in(point_of(Type::REAL), Registers{0x7FC0, 0}.data())));
  EXPECT_TRUE(std::isinf(value_in(point_of(Type::REAL), Registers{0x7F80, 0}.data())));
}

TEST(AnalogueValue, Comes_back_from_every_type) {
  for (const Type type :
       {Type::BYTE, Type::SINT, Type::USINT, Type::INT, Type::UINT, Type::WORD, Type::DINT, Type::UDINT,
        Type::DWORD, Type::LINT, Type::ULINT, Type::LWORD, Type::REAL, Type::LREAL}) {
    const Point point = point_of(type, {0.5, 0});
    EXPECT_DOUBLE_EQ(42.5, value_in(point, put(42.5, point).data())) << to_string(type);
  }
}

}  // namespace
}  // namespace coupler::node
