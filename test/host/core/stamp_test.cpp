// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/core/stamp.hpp"

#include <gmock/gmock.h>

#include "test/host/core/device_fixture.hpp"

namespace coupler::host {
namespace {

using std::chrono::milliseconds;
using test::DeviceTest;
using testing::SizeIs;

TEST(Stamp, It_is_the_middle_between_request_and_reply_and_half_of_the_distance) {
  const Time sent = Time{} + milliseconds(1000);
  const Stamp stamp = stamp_between(sent, sent + milliseconds(30));
  EXPECT_EQ(stamp.at, sent + milliseconds(15));
  EXPECT_EQ(stamp.uncertainty, milliseconds(15));
}

TEST(Stamp, Both_ends_are_within_it_whatever_the_rounding) {
  const Time sent = Time{} + milliseconds(1000);
  for (const Duration distance : {Duration(0), Duration(1), Duration(2), Duration(7)}) {
    const Stamp stamp = stamp_between(sent, sent + distance);
    EXPECT_LE(stamp.at - stamp.uncertainty, sent);
    EXPECT_GE(stamp.at + stamp.uncertainty, sent + distance);
  }
}

TEST_F(DeviceTest, A_value_is_stamped_between_its_request_and_its_reply) {
  start(MapBuilder().holding("a", 5), Verify::off);
  engine->step();  // connects
  device.reply_time = milliseconds(30);
  const Time sent = clock.now();
  engine->step();
  ASSERT_THAT(sink->stamps, SizeIs(1));
  EXPECT_EQ(sink->stamps[0].at, sent + milliseconds(15));
  EXPECT_EQ(sink->stamps[0].uncertainty, milliseconds(15));
}

TEST_F(DeviceTest, Each_request_of_a_cycle_has_a_stamp_of_its_own) {
  start(MapBuilder().holding("a", 1).holding("b", 100), Verify::off);
  engine->step();
  device.reply_time = milliseconds(10);
  const Time sent = clock.now();
  engine->step();
  engine->step();
  ASSERT_THAT(sink->stamps, SizeIs(2));
  EXPECT_EQ(sink->stamps[0].at, sent + milliseconds(5));
  EXPECT_EQ(sink->stamps[1].at, sent + milliseconds(15));
}

TEST_F(DeviceTest, A_pause_before_the_request_is_not_in_the_stamp) {
  auto builder = MapBuilder().holding("a", 1).holding("b", 100);
  builder.head().limits.request_gap = milliseconds(40);
  start(builder, Verify::off);
  engine->step();
  device.reply_time = milliseconds(10);
  engine->step();
  const Time answered = clock.now();
  engine->step();
  ASSERT_THAT(sink->stamps, SizeIs(2));
  EXPECT_EQ(sink->stamps[1].at, answered + milliseconds(45));
  EXPECT_EQ(sink->stamps[1].uncertainty, milliseconds(5));
}

}  // namespace
}  // namespace coupler::host
