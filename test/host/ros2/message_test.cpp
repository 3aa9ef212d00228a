// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <rosidl_runtime_cpp/traits.hpp>

#include "coupler/docs/words.hpp"
#include "coupler/host/ros2/messages.hpp"

namespace coupler::host {
namespace {

Point point_of(codec::Type type, std::uint16_t count) {
  Point point;
  point.name = "row";
  point.table = type == codec::Type::BOOL ? Table::coils : Table::holding_registers;
  point.format.type = type;
  point.count = count;
  return point;
}

/// "std_msgs/msg/Bool" without the "msg/" that ROS 2 has.
std::string ros1_name(std::string name) { return name.erase(name.find("/msg/"), 4); }

TEST(Message, The_types_are_those_of_ROS_1) {
  using codec::Type;
  for (const Type type : {Type::BOOL, Type::BYTE, Type::WORD, Type::DWORD, Type::LWORD, Type::SINT, Type::INT,
                          Type::DINT, Type::LINT, Type::USINT, Type::UINT, Type::UDINT, Type::ULINT,
                          Type::REAL, Type::LREAL, Type::CHAR, Type::STRING})
    for (const std::uint16_t count : {std::uint16_t{1}, std::uint16_t{3}}) {
      if (count > 1 && codec::width(type) <= 8 && type != Type::BOOL) continue;  // no arrays of these
      const Point point = point_of(type, count);
      const std::string carried = with_message<Ros2Messages>(point, [](auto kind) {
        return std::string(rosidl_generator_traits::name<typename decltype(kind)::Message>());
      });
      EXPECT_EQ(docs::ros_message(point), ros1_name(carried)) << codec::to_string(type) << " x " << count;
    }
}

TEST(Message, The_types_of_stamped_values_are_those_of_ROS_1) {
  using codec::Type;
  const auto carried = [](Type type, double gain = 1) {
    Point point = point_of(type, 1);
    point.scale.gain = gain;
    return with_stamped_message<Ros2Messages>(point, [](auto kind) {
      return std::string(rosidl_generator_traits::name<typename decltype(kind)::Message>());
    });
  };
  EXPECT_EQ(carried(Type::BOOL), "coupler_driver/msg/BoolStamped");
  EXPECT_EQ(carried(Type::SINT), "coupler_driver/msg/Int64Stamped");
  EXPECT_EQ(carried(Type::LWORD), "coupler_driver/msg/UInt64Stamped");
  EXPECT_EQ(carried(Type::REAL), "coupler_driver/msg/Float64Stamped");
  EXPECT_EQ(carried(Type::INT, 0.1), "coupler_driver/msg/Float64Stamped");
  EXPECT_EQ(carried(Type::STRING), "coupler_driver/msg/StringStamped");
}

TEST(Message, A_stamp_is_in_wall_time) {
  WallTime wall;
  wall.measure(Time{}, std::chrono::seconds(100), Time{});
  Stamper put(wall);
  coupler_driver::msg::BoolStamped message;
  put(message, {Time{} + std::chrono::milliseconds(1250), {}});
  EXPECT_EQ(message.header.stamp.sec, 101);
  EXPECT_EQ(message.header.stamp.nanosec, 250'000'000U);
  EXPECT_EQ(message.sequence, 1U);
}

TEST(Message, The_bits_of_several_words_follow_each_other) {
  const Point point = point_of(codec::Type::WORD, 2);
  using Bits = BitsMessage<std::uint16_t, coupler_driver::msg::BoolArray>;
  const std::vector<std::uint16_t> registers{0x0001, 0x8000};
  Bits::Message message;
  Bits::decode(registers.data(), point, message);
  ASSERT_EQ(message.data.size(), 32U);
  for (std::size_t i = 0; i < 32; ++i) EXPECT_EQ(message.data[i], i == 0 || i == 31) << i;
  std::vector<std::uint16_t> back(2);
  EXPECT_EQ(Bits::encode(message, point, back.data()), "");
  EXPECT_EQ(back, registers);
}

}  // namespace
}  // namespace coupler::host
