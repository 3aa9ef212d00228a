// SPDX-License-Identifier: Apache-2.0
// A foreign device that says nothing, or nonsense, where others refuse.
#include <gmock/gmock.h>

#include "test/host/core/device_fixture.hpp"

namespace coupler::host {
namespace {

using fakes::MapBuilder;
using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::ElementsAre;

class UnansweredReadsTest : public test::DeviceTest {
 protected:
  void SetUp() override {
    device.during_read = [this] {
      if (ends_connections(device.requests.back())) device.next_errors = {Timeout{milliseconds(3000)}};
    };
  }
  /// Requests for register 6.
  bool ends_connections(const std::string& request) const {
    return silent && (request == "read holding_registers 5+2" || request == "read holding_registers 6+1");
  }

  bool silent = true;
};

TEST_F(UnansweredReadsTest, It_costs_its_own_points_only_and_is_tried_less_and_less_often) {
  start(MapBuilder().holding("a", 0).holding("b", 5).holding("c", 6), Verify::off);
  run_for(seconds(5));
  EXPECT_THAT(sink->online, ElementsAre(true, false, true)) << "the first time it may have been away";
  EXPECT_EQ(sink->reported("c cannot be read: no reply"), 1);
  EXPECT_EQ(device.count("read holding_registers 6+1"), 1U);
  device.requests.clear();
  run_for(seconds(9));
  EXPECT_EQ(device.count("read holding_registers 6+1"), 1U) << "after 10 s";
  run_for(seconds(15));
  EXPECT_EQ(device.count("read holding_registers 6+1"), 1U);
  run_for(seconds(4));
  EXPECT_EQ(device.count("read holding_registers 6+1"), 2U) << "after 20 s more";
  run_for(std::chrono::hours(2));
  const std::size_t tried = device.count("read holding_registers 6+1");
  run_for(std::chrono::minutes(21));
  EXPECT_EQ(device.count("read holding_registers 6+1"), tried + 2) << "at last every ten minutes";
  EXPECT_THAT(sink->online, ElementsAre(true, false, true));
  EXPECT_EQ(device.count("read holding_registers 5+2"), 0U) << "what is guilty stays apart";
  silent = false;
  run_for(std::chrono::minutes(10));
  EXPECT_EQ(sink->reported("c can be read again"), 1);
}

TEST_F(UnansweredReadsTest, All_points_of_an_area_that_is_given_only_whole_are_reported_once) {
  static const TableRange area[] = {{Table::holding_registers, modbus::Range::of(5, 2)}};
  auto builder = MapBuilder().holding("a", 0).holding("b", 5).holding("c", 6);
  builder.head().read_whole = area;
  start(builder, Verify::off);
  run_for(seconds(5));
  EXPECT_EQ(sink->reported("holding_registers 5 to 6 (b, c) cannot be read: no reply"), 1);
  EXPECT_EQ(sink->reported("cannot be read"), 1);
}

TEST_F(UnansweredReadsTest, The_first_request_of_all_may_be_the_one) {
  start(MapBuilder().holding("b", 5).holding("c", 6).holding("d", 9), Verify::off);
  run_for(seconds(5));
  EXPECT_THAT(sink->online, testing::Contains(true));
  EXPECT_TRUE(sink->online.back());
  EXPECT_EQ(sink->reported("c cannot be read"), 1);
}

TEST_F(UnansweredReadsTest, Waiting_writes_stay_and_nothing_is_restored) {
  MapBuilder builder;
  builder.holding("a", 0).holding("b", 5).holding("c", 6).head().on_reconnect = OnReconnect::restore;
  start(builder, Verify::off);
  run_for(seconds(5));
  push("a", 7);
  run_for(seconds(1));
  device.requests.clear();
  run_for(seconds(40));  // it is tried twice
  EXPECT_EQ(device.count("read holding_registers 6+1"), 2U);
  EXPECT_EQ(device.count("write register 0"), 0U);
}

TEST_F(UnansweredReadsTest, A_device_that_is_silent_is_away_whatever_was_asked) {
  start(MapBuilder().holding("a", 0).holding("b", 5).holding("c", 6), Verify::off);
  run_for(seconds(5));
  device.is_mute = true;
  run_for(seconds(20));
  EXPECT_FALSE(sink->online.back());
  device.is_mute = false;
  run_for(seconds(6));
  EXPECT_TRUE(sink->online.back());
}

TEST_F(UnansweredReadsTest, Several_silent_requests_before_the_first_good_one_are_found_one_after_the_other) {
  device.during_read = [this] {
    const std::string& asked = device.requests.back();
    if (asked == "read holding_registers 0+1" || asked == "read holding_registers 5+1")
      device.next_errors = {Timeout{milliseconds(3000)}};
  };
  start(MapBuilder().holding("a", 0).holding("b", 5).holding("c", 9), Verify::off);
  run_for(seconds(9));
  EXPECT_TRUE(sink->online.back());
  EXPECT_EQ(sink->reported("a cannot be read: no reply"), 1);
  EXPECT_EQ(sink->reported("b cannot be read: no reply"), 1);
}

TEST_F(UnansweredReadsTest, A_device_that_comes_and_goes_is_told_in_a_few_lines) {
  start(MapBuilder().holding("a", 0), Verify::off);
  for (int i = 0; i < 300; ++i) {
    device.next_errors.push_back(TransportFailure{"reset"});
    run_for(milliseconds(200));
  }
  EXPECT_LE(sink->reported("connect"), 13) << "in a minute";
  run_for(seconds(11));
  EXPECT_THAT(sink->reports.back(), testing::HasSubstr("connected")) << "and the last state is told";
}

}  // namespace
}  // namespace coupler::host
