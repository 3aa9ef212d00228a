// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/ros1/messages.hpp"

#include <gmock/gmock.h>

#include <type_traits>
#include <vector>

#include "coupler/docs/words.hpp"

namespace coupler::host {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

Point point_of(codec::Type type, std::uint16_t count, Table table = Table::holding_registers) {
  Point point;
  point.name = "row";
  point.table = table;
  point.format.type = type;
  point.count = count;
  return point;
}

template <class Message>
bool is_carried_by(const Point& point) {
  return with_message<Ros1Messages>(
      point, [](auto kind) { return std::is_same_v<typename decltype(kind)::Message, Message>; });
}

TEST(Message, Arrays_have_the_array_message_of_their_type) {
  EXPECT_TRUE(is_carried_by<std_msgs::Int16>(point_of(codec::Type::INT, 1)));
  EXPECT_TRUE(is_carried_by<std_msgs::Int16MultiArray>(point_of(codec::Type::INT, 2)));
  EXPECT_TRUE(is_carried_by<std_msgs::UInt64MultiArray>(point_of(codec::Type::ULINT, 2)));
  EXPECT_TRUE(is_carried_by<std_msgs::Float32MultiArray>(point_of(codec::Type::REAL, 2)));
  EXPECT_TRUE(is_carried_by<coupler_driver::BoolArray>(point_of(codec::Type::WORD, 2)));
  EXPECT_TRUE(is_carried_by<coupler_driver::BoolArray>(point_of(codec::Type::BOOL, 2, Table::coils)));
}

TEST(Message, The_pages_of_a_map_name_the_type_of_every_message) {
  using codec::Type;
  for (const Type type : {Type::BOOL, Type::BYTE, Type::WORD, Type::DWORD, Type::LWORD, Type::SINT, Type::INT,
                          Type::DINT, Type::LINT, Type::USINT, Type::UINT, Type::UDINT, Type::ULINT,
                          Type::REAL, Type::LREAL, Type::CHAR, Type::STRING})
    for (const std::uint16_t count : {std::uint16_t{1}, std::uint16_t{3}})
      for (const double gain : {1.0, 0.1}) {
        if (count > 1 && (codec::width(type) <= 8) && type != Type::BOOL) continue;  // no arrays of these
        Point point = point_of(type, count, type == Type::BOOL ? Table::coils : Table::holding_registers);
        if (codec::is_scalable(type)) point.scale.gain = gain;
        const std::string carried = with_message<Ros1Messages>(point, [](auto kind) {
          return std::string(ros::message_traits::DataType<typename decltype(kind)::Message>::value());
        });
        EXPECT_EQ(docs::ros_message(point), carried) << codec::to_string(type) << " × " << count;
      }
}

TEST(Message, An_array_has_one_dimension_with_the_points_name) {
  const Point point = point_of(codec::Type::INT, 3);
  const std::vector<std::uint16_t> registers{1, 2, 0xFFFF};
  std_msgs::Int16MultiArray message;
  ArrayMessage<std::int16_t, std_msgs::Int16MultiArray>::decode(registers.data(), point, message);
  EXPECT_THAT(message.data, ElementsAre(1, 2, -1));
  ASSERT_EQ(message.layout.dim.size(), 1U);
  EXPECT_EQ(message.layout.dim[0].label, "row");
  EXPECT_EQ(message.layout.dim[0].size, 3U);
  EXPECT_EQ(message.layout.dim[0].stride, 3U);
}

TEST(Message, Elements_that_are_wider_than_a_register_stand_one_behind_the_other) {
  const Point point = point_of(codec::Type::UDINT, 2);
  using Kind = ArrayMessage<std::uint32_t, std_msgs::UInt32MultiArray>;
  Kind::Message message;
  message.data = {0x00010002, 0x00030004};
  std::vector<std::uint16_t> registers(4);
  EXPECT_EQ(Kind::encode(message, point, registers.data()), "");
  EXPECT_THAT(registers, ElementsAre(1, 2, 3, 4));
  Kind::Message back;
  Kind::decode(registers.data(), point, back);
  EXPECT_EQ(back.data, message.data);
}

TEST(Message, The_bits_of_several_words_follow_each_other) {
  const Point point = point_of(codec::Type::WORD, 2);
  using Kind = BitsMessage<std::uint16_t, coupler_driver::BoolArray>;
  const std::vector<std::uint16_t> registers{0x0001, 0x8000};
  Kind::Message message;
  Kind::decode(registers.data(), point, message);
  ASSERT_EQ(message.data.size(), 32U);
  for (std::size_t i = 0; i < 32; ++i) EXPECT_EQ(message.data[i] != 0, i == 0 || i == 31) << i;
  std::vector<std::uint16_t> back(2);
  EXPECT_EQ(Kind::encode(message, point, back.data()), "");
  EXPECT_EQ(back, registers);
}

TEST(Message, Several_coils_are_one_element_each) {
  const Point point = point_of(codec::Type::BOOL, 3, Table::coils);
  const std::vector<std::uint16_t> registers{1, 0, 1};
  BoolsMessage<coupler_driver::BoolArray>::Message message;
  BoolsMessage<coupler_driver::BoolArray>::decode(registers.data(), point, message);
  EXPECT_THAT(message.data, ElementsAre(1, 0, 1));
  std::vector<std::uint16_t> back(3, 7);
  EXPECT_EQ(BoolsMessage<coupler_driver::BoolArray>::encode(message, point, back.data()), "");
  EXPECT_EQ(back, registers);
}

TEST(Message, A_scaled_point_is_a_Float64_and_an_array_of_them) {
  Point point = point_of(codec::Type::INT, 2);
  point.scale = {0.5, 10};
  EXPECT_TRUE(is_carried_by<std_msgs::Float64MultiArray>(point));
  const std::vector<std::uint16_t> registers{4, 0xFFFF};
  ScaledArrayMessage<std_msgs::Float64MultiArray>::Message message;
  ScaledArrayMessage<std_msgs::Float64MultiArray>::decode(registers.data(), point, message);
  EXPECT_THAT(message.data, ElementsAre(12, 9.5));
  std::vector<std::uint16_t> back(2);
  EXPECT_EQ(ScaledArrayMessage<std_msgs::Float64MultiArray>::encode(message, point, back.data()), "");
  EXPECT_EQ(back, registers);
  message.data[1] = 1e9;
  EXPECT_THAT(ScaledArrayMessage<std_msgs::Float64MultiArray>::encode(message, point, back.data()),
              HasSubstr("out of range"));
  point.count = 1;
  EXPECT_TRUE(is_carried_by<std_msgs::Float64>(point));
}

TEST(Message, A_value_without_room_in_its_bits_is_refused_and_the_register_stays) {
  std::vector<std::uint16_t> registers{0xA5A5};
  Point byte = point_of(codec::Type::BYTE, 1);
  byte.format.bit = 8;
  byte.format.bits = 4;
  using Bits = BitsMessage<std::uint8_t, coupler_driver::BoolArray>;
  Bits::Message bits;
  bits.data = {1, 1, 0, 0, 1, 0, 0, 0};
  EXPECT_EQ(Bits::encode(bits, byte, registers.data()), "19 does not fit into 4 bits; send 0 to 15");
  Point number = byte;
  number.format.type = codec::Type::UINT;
  std_msgs::UInt16 sixteen;
  sixteen.data = 16;
  using Number = NumberMessage<std::uint16_t, std_msgs::UInt16>;
  EXPECT_EQ(Number::encode(sixteen, number, registers.data()), "16 does not fit into 4 bits; send 0 to 15");
  EXPECT_EQ(registers[0], 0xA5A5);
  bits.data[4] = 0;
  EXPECT_EQ(Bits::encode(bits, byte, registers.data()), "");
  EXPECT_EQ(registers[0], 0xA3A5);
}

TEST(Message, A_wrong_number_of_elements_is_refused_with_the_right_one) {
  std::vector<std::uint16_t> registers(8);
  std_msgs::Int16MultiArray numbers;
  numbers.data = {1, 2};
  const std::string wrong = ArrayMessage<std::int16_t, std_msgs::Int16MultiArray>::encode(
      numbers, point_of(codec::Type::INT, 3), registers.data());
  EXPECT_EQ(wrong, "2 elements; send 3");
  using Words = BitsMessage<std::uint16_t, coupler_driver::BoolArray>;
  Words::Message bits;
  bits.data.resize(16);
  EXPECT_THAT(Words::encode(bits, point_of(codec::Type::WORD, 2), registers.data()), HasSubstr("send 32"));
}

}  // namespace
}  // namespace coupler::host
