// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/core/coupler_watchdog.hpp"

#include <gmock/gmock.h>

#include "test/host/core/fake_device.hpp"

namespace coupler::host {
namespace {

using modbus::Exception;
using test::FakeDevice;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;
using Step = WatchdogSequences::Write;

constexpr Step steps[] = {{Table::holding_registers, 0x1008, 0xAA55, false},
                          {Table::coils, 7, 1, false},
                          {Table::holding_registers, 0x1009, 3, false}};

struct WatchdogWrites : ::testing::Test {
  WatchdogWrites() {
    EXPECT_TRUE(link.connect());
    device.requests.clear();
  }
  FakeDevice device;
  Map map;
  Link link{test::share(device), {}, {}};
};

TEST_F(WatchdogWrites, Each_is_a_request_by_itself_in_order) {
  const auto refused = write_steps(steps, map, link);
  ASSERT_TRUE(refused);
  EXPECT_FALSE(refused->has_value());
  EXPECT_THAT(device.requests, ElementsAre("write register 4104", "write coil 7", "write register 4105"));
  EXPECT_EQ((device.values[{Table::holding_registers, 0x1008}]), 0xAA55);
  EXPECT_EQ((device.values[{Table::coils, 7}]), 1);
}

TEST_F(WatchdogWrites, The_first_one_refused_ends_them) {
  device.missing.insert({Table::coils, 7});
  const auto refused = write_steps(steps, map, link);
  ASSERT_TRUE(refused && *refused);
  EXPECT_EQ((*refused)->step.address, 7);
  EXPECT_EQ((*refused)->code, Exception::illegal_data_address);
  EXPECT_THAT(device.requests, ElementsAre("write register 4104", "write coil 7"));
}

TEST_F(WatchdogWrites, What_has_its_value_already_is_left_alone) {
  constexpr Step kept[] = {{Table::holding_registers, 0x1120, 500, true}};
  ASSERT_TRUE(write_steps(kept, map, link));
  ASSERT_TRUE(write_steps(kept, map, link));
  EXPECT_THAT(device.requests, ElementsAre("read holding_registers 4384+1", "write register 4384",
                                           "read holding_registers 4384+1"));
}

TEST_F(WatchdogWrites, A_unit_that_is_away_is_an_error) {
  device.next_errors = {ExceptionReply{Exception::gateway_target_failed_to_respond}};
  EXPECT_FALSE(write_steps(steps, map, link));
  device.next_errors = {ExceptionReply{Exception::gateway_target_failed_to_respond}};
  EXPECT_FALSE(has_value(steps[0], map, link));
}

TEST_F(WatchdogWrites, What_cannot_be_read_has_no_value) {
  device.missing.insert({Table::coils, 7});
  const auto answer = has_value({Table::coils, 7, 0, false}, map, link);
  ASSERT_TRUE(answer);
  EXPECT_FALSE(*answer);
}

TEST_F(WatchdogWrites, A_refusal_is_told_with_what_to_do) {
  EXPECT_THAT(
      to_string(RejectedStep{steps[0], Exception::server_device_busy}),
      AllOf(StartsWith("writing 43605 to holding_registers 4104: exception 06 (server device busy); "),
            HasSubstr("another client owns its outputs")));
  EXPECT_THAT(to_string(RejectedStep{steps[1], Exception::illegal_data_address}), HasSubstr("'preset'"));
  EXPECT_THAT(to_string(RejectedStep{steps[1], Exception::illegal_data_value}),
              HasSubstr("docs/couplers.md"));
}

}  // namespace
}  // namespace coupler::host
