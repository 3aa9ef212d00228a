// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/ros/stamped_message.hpp"

#include <gmock/gmock.h>

#include <string>
#include <tuple>

#include "coupler/host/ros1/messages.hpp"

namespace coupler::host {
namespace {

using codec::Type;
using std::chrono::milliseconds;
using std::chrono::nanoseconds;
using std::chrono::seconds;

std::string message_of(const Point& point) {
  return with_stamped_message<Ros1Messages>(point, [](auto kind) {
    return std::string(ros::message_traits::DataType<typename decltype(kind)::Message>::value());
  });
}

std::string message_of(Type type, double gain = 1) {
  Point point;
  point.table = Table::input_registers;
  point.format.type = type;
  point.scale.gain = gain;
  return message_of(point);
}

TEST(StampedMessage, There_is_one_for_each_class_of_types) {
  Point coil;
  coil.format.type = Type::BOOL;
  EXPECT_EQ(message_of(coil), "coupler_driver/BoolStamped");
  EXPECT_EQ(message_of(Type::BOOL), "coupler_driver/BoolStamped");
  for (const Type type : {Type::SINT, Type::INT, Type::DINT, Type::LINT})
    EXPECT_EQ(message_of(type), "coupler_driver/Int64Stamped");
  for (const Type type : {Type::USINT, Type::UINT, Type::UDINT, Type::ULINT, Type::BYTE, Type::WORD,
                          Type::DWORD, Type::LWORD, Type::CHAR})
    EXPECT_EQ(message_of(type), "coupler_driver/UInt64Stamped");
  for (const Type type : {Type::REAL, Type::LREAL})
    EXPECT_EQ(message_of(type), "coupler_driver/Float64Stamped");
  EXPECT_EQ(message_of(Type::STRING), "coupler_driver/StringStamped");
  EXPECT_EQ(message_of(Type::INT, 0.1), "coupler_driver/Float64Stamped");
}

TEST(StampedMessage, A_signed_value_stays_negative) {
  Point point;
  point.table = Table::input_registers;
  point.format.type = Type::INT;
  const std::uint16_t word = 0xFFFE;
  coupler_driver::Int64Stamped message;
  StampedNumber<std::int16_t, coupler_driver::Int64Stamped>::decode(&word, point, message);
  EXPECT_EQ(message.value, -2);
}

struct StamperTest : testing::Test {
  StamperTest() { wall.measure(Time{}, seconds(100), Time{} + nanoseconds(200)); }
  WallTime wall;
  Stamper put{wall};
  coupler_driver::BoolStamped message;
};

TEST_F(StamperTest, A_stamp_is_in_wall_time) {
  put(message, {Time{} + milliseconds(1250), milliseconds(5)});
  EXPECT_EQ(message.header.stamp.sec, 101U);
  EXPECT_EQ(message.header.stamp.nsec, 250'000'000U - 100);
  EXPECT_EQ(message.header.frame_id, "");
}

TEST_F(StamperTest, A_sample_says_since_when_its_value_is_known_and_whether_the_one_before_is) {
  SampleStamper sample(wall);
  coupler_driver::Int64Sample told;
  const auto publish = [&](int second, bool is_new) {
    const Sample seen{{Time{} + seconds(second), {}}, second == 3, is_new};
    sample.see(seen);
    sample(told, seen);
    return std::tuple(told.since.sec, bool(told.after_gap), bool(told.told));
  };
  EXPECT_EQ(publish(1, true), std::tuple(100U, true, false));
  EXPECT_EQ(publish(2, false), std::tuple(100U, false, false));
  EXPECT_EQ(publish(3, true), std::tuple(102U, false, true));
  sample.see({{Time{} + seconds(4), {}}, false, true});  // it is no news, and not published
  EXPECT_EQ(publish(5, false), std::tuple(103U, false, false));
  sample.forget();
  EXPECT_EQ(publish(6, false), std::tuple(105U, true, false));
}

TEST_F(StamperTest, The_uncertainty_is_in_seconds_and_holds_the_error_between_the_clocks) {
  put(message, {Time{}, milliseconds(5)});
  EXPECT_DOUBLE_EQ(message.uncertainty, 0.0050001);
}

TEST_F(StamperTest, A_stamp_does_not_go_back_with_a_better_measurement) {
  wall = {};
  wall.measure(Time{}, seconds(100) + milliseconds(4), Time{} + milliseconds(8));
  put(message, {Time{} + seconds(1), {}});
  const auto before = message.header.stamp;
  wall.measure(Time{}, seconds(100), Time{});  // the clock was read at the end of the first
  put(message, {Time{} + seconds(1), milliseconds(1)});
  EXPECT_EQ(message.header.stamp, before);
  EXPECT_DOUBLE_EQ(message.uncertainty, 0.001) << "both say the same";
}

TEST_F(StamperTest, Messages_are_counted_from_1) {
  put(message, {});
  EXPECT_EQ(message.sequence, 1U);
  put(message, {});
  EXPECT_EQ(message.sequence, 2U);
}

}  // namespace
}  // namespace coupler::host
