// SPDX-License-Identifier: Apache-2.0
// Scheduled writes that are made even if their time has passed.
#include <gmock/gmock.h>

#include "test/host/core/schedule_fixture.hpp"

namespace coupler::host {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using test::Became;

struct LateWritesTest : test::TimedOutputsTest {};

TEST_F(LateWritesTest, What_may_be_late_is_written_at_once_and_what_follows_it_at_the_point_by_the_driver) {
  begin_node(press());
  ScheduledWrite late = wanted("lamp", 1, milliseconds(-20));
  EXPECT_THAT(schedule(late).text, testing::HasSubstr("in the past"));
  late.may_be_late = milliseconds(30);
  EXPECT_EQ(schedule(late).text, "accepted: the driver does it");
  EXPECT_EQ(schedule("lamp", 0, seconds(5)).text, "accepted: the driver does it");
  EXPECT_EQ(schedule("horn", 0, seconds(5)).text, "accepted: the device does it");
  run_for(milliseconds(10));
  EXPECT_EQ(lamp(), 1);
}

TEST_F(LateWritesTest, What_becomes_late_on_the_way_is_written_at_once) {
  begin_node(press());
  device.refuses = [this](const std::string& request) {
    if (request != "schedule") return std::optional<modbus::Exception>();
    clock.advance(milliseconds(10));
    return std::optional(modbus::Exception::illegal_data_value);
  };
  ScheduledWrite soon = wanted("lamp", 1, milliseconds(5));
  soon.may_be_late = milliseconds(30);
  EXPECT_EQ(schedule(soon).text, "accepted: the driver does it");
  run_for(milliseconds(10));
  EXPECT_EQ(lamp(), 1);
}

TEST_F(LateWritesTest, What_is_later_than_it_may_be_is_refused_or_has_failed) {
  begin_foreign(press());
  ScheduledWrite late = wanted("lamp", 1, milliseconds(-40));
  late.may_be_late = milliseconds(30);
  EXPECT_THAT(schedule(late).text, testing::HasSubstr("in the past"));
  late.due = clock.now() + milliseconds(5);
  EXPECT_NE(schedule(late).number, 0U);
  clock.advance(milliseconds(50));
  run_for(milliseconds(10));
  EXPECT_EQ(outcome().result, Became::failed);
  EXPECT_EQ(lamp(), 0);
}

}  // namespace
}  // namespace coupler::host
