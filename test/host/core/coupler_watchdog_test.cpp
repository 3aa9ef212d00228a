// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/core/coupler_watchdog.hpp"

#include <gmock/gmock.h>

#include "test/fakes/map_builder.hpp"
#include "test/host/core/device_fixture.hpp"

namespace coupler::host {
namespace {

using modbus::Exception;
using std::chrono::milliseconds;
using std::chrono::seconds;
using ::testing::ElementsAre;
using State = WatchdogStatus::State;
using Step = WatchdogSequences::Write;

constexpr Step arm[] = {{Table::holding_registers, 1000, 3, false},
                        {Table::holding_registers, 1003, 1, false},
                        {Table::holding_registers, 1003, 2, false}};
constexpr Step feed[] = {{Table::holding_registers, 1003, 1, false},
                         {Table::holding_registers, 1003, 2, false}};
constexpr Step reset[] = {{Table::holding_registers, 1007, 1, false}};
constexpr Step clear[] = {{Table::coils, 4144, 0, false}};

/// A driver of a coupler with a watchdog of 300 ms, fed by register 1003, reset by 1007.
struct CouplerWatchdogTest : test::DeviceTest {
  CouplerWatchdogTest() {
    known.timeout = milliseconds(300);
    known.feed_every = milliseconds(100);
    known.arm = arm;
    known.feed = feed;
    known.reset = reset;
    known.refusal = Exception::server_device_failure;
  }

  /// With outputs `valve` and `speed` that are restored, polled once in ten seconds.
  void start_with_watchdog(OnReconnect on_reconnect = OnReconnect::restore) {
    fakes::MapBuilder builder;
    builder.add(Table::coils, "valve", 4, codec::Type::BOOL);
    builder.add(Table::holding_registers, "speed", 5, codec::Type::UINT);
    builder.head().on_reconnect = on_reconnect;
    builder.head().polling.rate = 0.1;
    builder.head().coupler_watchdog = known;
    builder.head().read_whole = read_whole;
    owned = builder.build();
    make_sink();
    make_engine(Verify::off, nullptr);
  }

  /// The watchdog fires: outputs go off, and every request is refused until register 1007 is written.
  void expire() {
    device.values[{Table::coils, 4}] = 0;
    device.refuses = [this](const std::string& request) -> std::optional<Exception> {
      if (request != "write register 1007") return Exception::server_device_failure;
      device.refuses = nullptr;
      return std::nullopt;
    };
  }

  std::vector<std::string> requests_of(Duration duration) {
    device.requests.clear();
    run_for(duration);
    return device.requests;
  }
  std::uint16_t valve() { return device.values[{Table::coils, 4}]; }
  WatchdogStatus status() const { return engine->statistics().watchdog; }

  WatchdogSequences known;
  Span<const TableRange> read_whole;
};

TEST_F(CouplerWatchdogTest, It_is_armed_before_anything_else_is_written_and_again_at_each_connect) {
  start_with_watchdog();
  for (int i = 0; i < 2; ++i) {
    push("valve", 1);
    const auto requests = requests_of(milliseconds(50));
    ASSERT_GE(requests.size(), 5U);
    EXPECT_THAT(std::vector<std::string>(requests.begin(), requests.begin() + 5),
                ElementsAre("connect", "read coils 4+1", "write register 1000", "write register 1003",
                            "write register 1003"));
    EXPECT_EQ(status().state, State::fed);
    device.next_errors = {TransportFailure{"gone"}};
    push("speed", 1);
    run_for(milliseconds(1));
    EXPECT_EQ(status().state, State::not_fed);
    run_for(milliseconds(99));
  }
}

TEST_F(CouplerWatchdogTest, It_is_fed_in_turn_three_times_in_a_timeout) {
  start_with_watchdog();
  run_for(milliseconds(50));
  std::vector<std::uint16_t> values;
  device.refuses = [&](const std::string& request) {
    if (request == "write register 1003") values.push_back(device.values[{Table::holding_registers, 1003}]);
    return std::optional<Exception>();
  };
  run_for(milliseconds(900));
  EXPECT_EQ(values, (std::vector<std::uint16_t>{2, 1, 2, 1, 2, 1, 2, 1, 2}));  // as it was before
}

TEST_F(CouplerWatchdogTest, After_it_has_expired_it_is_reset_and_armed_and_outputs_are_restored) {
  start_with_watchdog();
  push("valve", 1);
  run_for(milliseconds(50));
  expire();
  EXPECT_THAT(
      requests_of(milliseconds(110)),
      ElementsAre("write register 1003", "read coils 4+1", "write register 1007", "read coils 4+1",
                  "write register 1000", "write register 1003", "write register 1003", "write coil 4"));
  EXPECT_EQ(valve(), 1);
  EXPECT_EQ(status().state, State::fed);
  EXPECT_EQ(status().expiries, 1U);
  EXPECT_EQ(sink->reported("watchdog has expired: 300 ms without a request"), 1);
  EXPECT_EQ(sink->reported("reset and fed: outputs go off after 300 ms"), 1);
}

TEST_F(CouplerWatchdogTest, Outputs_that_are_not_to_be_restored_stay_off_and_that_is_told) {
  start_with_watchdog(OnReconnect::drop);
  push("valve", 1);
  run_for(milliseconds(50));
  expire();
  run_for(milliseconds(500));
  EXPECT_EQ(valve(), 0);
  EXPECT_EQ(status().state, State::fed);
  EXPECT_EQ(sink->reported("outputs stay off until they are written"), 1);
}

TEST_F(CouplerWatchdogTest, A_write_that_waits_goes_out_behind_the_reset) {
  start_with_watchdog();
  run_for(milliseconds(50));
  expire();
  run_for(milliseconds(49));
  clock.advance(milliseconds(1000));
  push("valve", 1);
  run_for(milliseconds(10));
  EXPECT_EQ(valve(), 1);
  EXPECT_EQ(engine->statistics().written(WriteResult::Outcome::exception), 0U);
}

TEST_F(CouplerWatchdogTest, With_manual_recovery_it_waits_for_the_call) {
  known.recovery = Watchdog::Recovery::manual;
  start_with_watchdog();
  push("valve", 1);
  run_for(milliseconds(50));
  expire();
  run_for(seconds(5));
  EXPECT_EQ(device.count("write register 1007"), 0U);
  EXPECT_EQ(status().state, State::expired);
  EXPECT_EQ(status().expiries, 1U);
  EXPECT_EQ(sink->reported("call device/reset_watchdog"), 1);

  auto answer = engine->reset_watchdog();
  run_for(milliseconds(10));
  const auto told = answer.get();
  EXPECT_TRUE(told.success);
  EXPECT_EQ(told.text, "reset, and fed again");
  EXPECT_EQ(status().state, State::fed);
  EXPECT_EQ(valve(), 1);
}

TEST_F(CouplerWatchdogTest, What_was_refused_while_it_had_expired_is_not_restored_and_nothing_older) {
  known.recovery = Watchdog::Recovery::manual;
  for (const std::uint16_t refused : {std::uint16_t{0}, std::uint16_t{1}}) {
    engine.reset();
    start_with_watchdog();
    push("valve", 1);
    run_for(milliseconds(50));
    expire();
    push("valve", refused);
    run_for(milliseconds(500));
    EXPECT_EQ(engine->statistics().written(WriteResult::Outcome::exception), 1U);

    device.requests.clear();
    auto answer = engine->reset_watchdog();
    run_for(milliseconds(10));
    EXPECT_TRUE(answer.get().success);
    EXPECT_EQ(device.count("write coil 4"), 0U);
    EXPECT_EQ(valve(), 0);
  }
}

TEST_F(CouplerWatchdogTest, With_manual_recovery_a_new_connection_does_not_reset_it_either) {
  known.recovery = Watchdog::Recovery::manual;
  start_with_watchdog();
  expire();
  run_for(seconds(3));
  EXPECT_EQ(device.count("write register 1007") + device.count("write register 1000"), 0U);
  EXPECT_EQ(status().state, State::expired);
}

TEST_F(CouplerWatchdogTest, Somebody_else_may_reset_it) {
  known.recovery = Watchdog::Recovery::manual;
  start_with_watchdog();
  run_for(milliseconds(50));
  expire();
  run_for(seconds(3));
  device.refuses = nullptr;
  run_for(seconds(2));
  EXPECT_EQ(status().state, State::fed);
  EXPECT_EQ(device.count("write register 1007"), 0U);
}

TEST_F(CouplerWatchdogTest, A_reset_that_does_not_help_is_told_once_and_tried_again) {
  start_with_watchdog();
  run_for(milliseconds(50));
  device.refuses = [](const std::string& request) {
    return request == "write register 1007" ? std::nullopt : std::optional(Exception::server_device_failure);
  };
  run_for(seconds(5));
  EXPECT_EQ(status().state, State::expired);
  EXPECT_EQ(status().expiries, 1U);
  EXPECT_EQ(sink->reported("writes to outputs are still refused"), 1);
  EXPECT_GE(device.count("write register 1007"), 3U);
  EXPECT_LE(device.count("write register 1007"), 6U);
}

TEST_F(CouplerWatchdogTest, What_one_point_answers_is_no_expiry_while_others_can_be_read) {
  start_with_watchdog();
  device.refuses = [](const std::string& request) {
    return request == "read holding_registers 5+1" ? std::optional(Exception::server_device_failure)
                                                   : std::nullopt;
  };
  run_for(seconds(30));
  EXPECT_EQ(status().state, State::fed);
  EXPECT_EQ(status().expiries, 0U);
  EXPECT_EQ(device.count("write register 1007"), 0U);
}

TEST_F(CouplerWatchdogTest, One_that_cannot_be_armed_is_told_once_and_tried_again) {
  device.missing.insert({Table::holding_registers, 1000});
  start_with_watchdog();
  run_for(seconds(3));
  EXPECT_EQ(status().state, State::not_fed);
  EXPECT_EQ(sink->reported(
                "cannot be armed: writing 3 to holding_registers 1000: exception 02 (illegal data address)"),
            1);
  EXPECT_TRUE(engine->statistics().online);
  device.missing.clear();
  run_for(seconds(2));
  EXPECT_EQ(status().state, State::fed);
  EXPECT_EQ(status().error_text, "");
}

TEST_F(CouplerWatchdogTest, One_that_can_no_longer_be_fed_is_armed_again) {
  start_with_watchdog();
  run_for(milliseconds(50));
  device.missing.insert({Table::holding_registers, 1003});
  run_for(milliseconds(200));
  EXPECT_EQ(status().state, State::not_fed);
  EXPECT_EQ(sink->reported("cannot be fed: writing 1 to holding_registers 1003: exception 02"), 1);
  device.missing.clear();
  run_for(seconds(2));
  EXPECT_EQ(status().state, State::fed);
}

TEST_F(CouplerWatchdogTest, Where_any_request_feeds_one_is_made_when_there_would_be_none) {
  known.feed = {};
  start_with_watchdog();
  run_for(milliseconds(50));
  const auto requests = requests_of(milliseconds(950));
  EXPECT_EQ(requests, std::vector<std::string>(9, "read coils 4+1"));
  push("speed", 1);
  run_for(milliseconds(1));
  device.requests.clear();
  for (int i = 0; i < 20; ++i) {
    push("speed", 1);
    run_for(milliseconds(50));
  }
  EXPECT_EQ(device.count("read coils 4+1"), 0U);
}

TEST_F(CouplerWatchdogTest, An_alarm_is_looked_at_as_often_as_it_is_to_be_fed) {
  known.arm = known.feed = {};
  known.refusal = {};
  known.reset = clear;
  known.alarm = Step{Table::coils, 4144, 1, false};
  start_with_watchdog();
  push("valve", 1);
  run_for(milliseconds(50));
  EXPECT_EQ(requests_of(milliseconds(950)), std::vector<std::string>(9, "read coils 4144+1"));
  device.values[{Table::coils, 4144}] = 1;
  device.values[{Table::coils, 4}] = 0;
  EXPECT_THAT(requests_of(milliseconds(100)),
              ElementsAre("read coils 4144+1", "write coil 4144", "read coils 4144+1", "write coil 4"));
  EXPECT_EQ(status().expiries, 1U);
  EXPECT_EQ(valve(), 1);
}

TEST_F(CouplerWatchdogTest, Where_the_device_gives_an_area_only_whole_it_is_read_whole) {
  static constexpr Step kept[] = {{Table::holding_registers, 1000, 3, true}};
  static const TableRange areas[] = {{Table::coils, modbus::Range::of(4140, 8)},
                                     {Table::holding_registers, modbus::Range::of(998, 4)}};
  read_whole = areas;
  known.arm = kept;
  known.feed = {};
  known.refusal = {};
  known.reset = clear;
  known.alarm = Step{Table::coils, 4144, 1, false};
  device.values[{Table::holding_registers, 1000}] = 3;
  start_with_watchdog();
  EXPECT_THAT(requests_of(milliseconds(10)),
              ElementsAre("connect", "read coils 4140+8", "read holding_registers 998+4", "read coils 4+1",
                          "read holding_registers 5+1"));
  device.values[{Table::coils, 4144}] = 1;
  EXPECT_THAT(requests_of(milliseconds(100)),
              ElementsAre("read coils 4140+8", "write coil 4144", "read coils 4140+8",
                          "read holding_registers 998+4"));
  EXPECT_EQ(status().expiries, 1U);
}

TEST_F(CouplerWatchdogTest, A_call_while_it_has_not_expired_changes_nothing) {
  start_with_watchdog();
  run_for(milliseconds(50));
  auto answer = engine->reset_watchdog();
  EXPECT_EQ(requests_of(milliseconds(20)), std::vector<std::string>{"read coils 4+1"});
  const auto told = answer.get();
  EXPECT_TRUE(told.success);
  EXPECT_EQ(told.text, "it had not expired");
}

TEST_F(CouplerWatchdogTest, A_call_that_finds_no_connection_is_answered) {
  device.refuse_connect = NotConnected{"connection refused"};
  start_with_watchdog();
  auto answer = engine->reset_watchdog();
  run_for(milliseconds(500));
  const auto told = answer.get();
  EXPECT_FALSE(told.success);
  EXPECT_EQ(told.text, "not connected");
}

TEST_F(CouplerWatchdogTest, A_call_whose_connection_breaks_is_answered_with_the_reason) {
  start_with_watchdog();
  run_for(milliseconds(50));
  device.next_errors = {TransportFailure{"gone"}};
  auto answer = engine->reset_watchdog();
  run_for(milliseconds(20));
  EXPECT_EQ(answer.get().text, "gone");
}

TEST_F(CouplerWatchdogTest, The_end_answers_who_still_waits) {
  start_with_watchdog();
  run_for(milliseconds(50));
  auto answer = engine->reset_watchdog();
  engine->stop();
  EXPECT_EQ(answer.get().text, "the driver ends");
}

TEST_F(CouplerWatchdogTest, A_map_without_one_makes_no_request_for_it) {
  known = {};
  start_with_watchdog();
  push("valve", 1);
  EXPECT_THAT(requests_of(milliseconds(500)),
              ElementsAre("connect", "write coil 4", "read coils 4+1", "read holding_registers 5+1"));
}

}  // namespace
}  // namespace coupler::host
