// SPDX-License-Identifier: Apache-2.0
// A generated client, config/examples/pump: values, connections, schedules.
#include <gmock/gmock.h>

#include <thread>

#include "test/host/client/pump_client_fixture.hpp"

namespace coupler::client {
namespace {

using namespace std::chrono_literals;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using Outcome = SetResult::Outcome;

TEST_F(PumpClient, Values_have_the_types_and_units_of_the_map) {
  auto& tables = server.tables();
  tables.tab_input_bits[0] = 1;
  const std::uint16_t inputs[] = {0xFF38, 0x3FC0, 0, 0xC000, 0, 0x0000, 0x0001, 0x1234, 0x5678};
  std::copy(std::begin(inputs), std::end(inputs), tables.tab_input_registers);
  const std::uint16_t text[] = {0x4162, 0x6300};
  std::copy(std::begin(text), std::end(text), tables.tab_registers + 1);
  pump.connect();
  EXPECT_EQ(pump.running.wait(soon)->value, true);
  EXPECT_DOUBLE_EQ(pump.pressure.wait(soon)->value, -2);
  EXPECT_THAT(pump.temperatures.wait(soon)->value,
              ElementsAre(1.5F, -2.0F, ::testing::FloatEq(1.401298e-45F)));
  EXPECT_EQ(pump.starts.wait(soon)->value, 0x12345678U);
  EXPECT_EQ(pump.label.wait(soon)->value, "Abc");
  EXPECT_EQ(pump.starts.get()->quality, Quality::good);
  EXPECT_LT(pump.starts.get()->age, soon);
}

TEST_F(PumpClient, What_is_set_arrives) {
  pump.connect();
  ASSERT_TRUE(pump.wait_online(soon));
  EXPECT_TRUE(pump.valve.set(true).get());
  EXPECT_TRUE(pump.speed.set(80.04).get());
  EXPECT_TRUE(pump.label.set("north").get());
  const auto& tables = server.tables();
  EXPECT_EQ(tables.tab_bits[0], 1);
  EXPECT_EQ(tables.tab_registers[0], 800);
  EXPECT_EQ(tables.tab_registers[1], 0x6E6F);
  EXPECT_EQ(tables.tab_registers[3], 0x6800);
}

TEST_F(PumpClient, A_value_that_is_none_of_its_point_is_refused_and_the_range_named) {
  const SetResult beyond = pump.speed.set(7000).get();
  EXPECT_EQ(beyond.outcome, Outcome::refused);
  EXPECT_THAT(beyond.text, HasSubstr("0 to 6553.5 %"));
  const SetResult none = pump.speed.set(std::nan("")).get();
  EXPECT_EQ(none.outcome, Outcome::refused);
  const SetResult longer = pump.label.set("seventeen letters").get();
  EXPECT_EQ(longer.outcome, Outcome::refused);
  EXPECT_THAT(longer.text, HasSubstr("at most 16 bytes"));
}

TEST_F(PumpClient, Values_that_are_written_together_are_one_request_where_they_are_neighbours) {
  std::vector<int> written;
  server.on_write = [&](int address) { written.push_back(address); };
  pump.connect();
  ASSERT_TRUE(pump.wait_online(soon));
  const SetResult result =
      pump.write_all({pump.label.to("north"), pump.valve.to(true), pump.speed.to(80)}).get();
  EXPECT_TRUE(result);
  EXPECT_EQ(result.text, "ok");
  EXPECT_THAT(written, ElementsAre(0, 0)) << "the coil, and all registers from 0 on";
  EXPECT_EQ(server.tables().tab_bits[0], 1);
  EXPECT_EQ(server.tables().tab_registers[0], 800);
  EXPECT_EQ(server.tables().tab_registers[1], 0x6E6F);
}

TEST_F(PumpClient, If_one_of_them_is_not_valid_none_is_written_and_its_point_is_named) {
  maps::pump::Client other(options());
  pump.connect();
  ASSERT_TRUE(pump.wait_online(soon));
  const SetResult beyond = pump.write_all({pump.valve.to(true), pump.speed.to(7000)}).get();
  EXPECT_EQ(beyond.outcome, Outcome::refused);
  EXPECT_THAT(beyond.text, AllOf(HasSubstr("speed: refused: "), HasSubstr("0 to 6553.5 %")));
  const SetResult anothers = pump.write_all({pump.valve.to(true), other.run.to(true)}).get();
  EXPECT_EQ(anothers.outcome, Outcome::refused);
  EXPECT_THAT(anothers.text, HasSubstr("run: refused: it is a point of another client"));
  EXPECT_EQ(pump.write_all({}).get().outcome, Outcome::refused);
  EXPECT_TRUE(pump.run.set(true).get()) << "what was written before is there now";
  EXPECT_EQ(server.tables().tab_bits[0], 0);
  const SetResult early = other.write_all({other.valve.to(true), other.run.to(true)}).get();
  EXPECT_EQ(early.outcome, Outcome::dropped);
  EXPECT_THAT(early.text, HasSubstr("valve: dropped: not connected"));
}

TEST_F(PumpClient, Before_connect_nothing_is_read_or_written) {
  EXPECT_FALSE(pump.online());
  EXPECT_FALSE(pump.wait_online(1ms));
  const SetResult result = pump.valve.set(true).get();
  EXPECT_EQ(result.outcome, Outcome::dropped);
  EXPECT_THAT(result.text, HasSubstr("connect()"));
  const auto value = pump.running.wait(1ms);
  ASSERT_FALSE(value);
  EXPECT_EQ(value.error().quality, Quality::offline);
}

TEST(NoValue, Says_why_there_is_none) {
  EXPECT_EQ(to_string(NoValue{Quality::never_read}), "was not read yet");
  EXPECT_EQ(to_string(NoValue{Quality::offline}), "was not read yet: the device does not answer");
  EXPECT_EQ(to_string(NoValue{Quality::rejected, modbus::Exception::illegal_data_address}),
            "cannot be read: exception 02 (illegal data address)");
  NoValue unusable{Quality::invalid};
  unusable.why_unusable = "the device gives 0x8000, which the map calls invalid";
  EXPECT_EQ(to_string(unusable), "has no value: the device gives 0x8000, which the map calls invalid");
  unusable.quality = Quality::offline;
  EXPECT_EQ(to_string(unusable), "has no value: the device does not answer");
}

TEST_F(PumpClient, Disconnected_it_keeps_its_last_values_as_offline_and_can_connect_again) {
  server.tables().tab_input_bits[0] = 1;
  pump.connect();
  ASSERT_TRUE(pump.running.wait(soon));
  pump.disconnect();
  EXPECT_FALSE(pump.online());
  EXPECT_TRUE(pump.running.get()->value);
  EXPECT_EQ(pump.running.get()->quality, Quality::offline);
  pump.connect();
  EXPECT_TRUE(pump.wait_online(soon));
  EXPECT_TRUE(pump.valve.set(true).get());
}

TEST_F(PumpClient, Connected_again_it_takes_no_value_from_before_for_a_good_one) {
  server.tables().tab_input_bits[0] = 1;
  pump.connect();
  ASSERT_TRUE(pump.running.wait(soon));
  pump.disconnect();
  server.tables().tab_input_bits[0] = 0;
  pump.connect();
  std::thread other([&] {
    for (const auto end = std::chrono::steady_clock::now() + soon; std::chrono::steady_clock::now() < end;) {
      const auto seen = pump.running.get();
      ASSERT_TRUE(seen);
      if (seen->quality != Quality::good) continue;
      EXPECT_FALSE(seen->value);
      return;
    }
  });
  const auto waited_for = pump.running.wait(soon);
  other.join();
  ASSERT_TRUE(waited_for);
  EXPECT_FALSE(waited_for->value);
}

/// Accepted in time, on any machine.
template <class Point, class Value>
PendingSchedule soon_set(Point& point, Value value) {
  for (auto ahead = 50ms;; ahead *= 2) {
    PendingSchedule pending = point.schedule(value, std::chrono::steady_clock::now() + ahead);
    if (pending.accepted() || ahead > std::chrono::minutes(30)) return pending;
  }
}

TEST_F(PumpClient, A_value_is_written_when_its_time_has_come) {
  pump.connect();
  ASSERT_TRUE(pump.wait_online(soon));
  PendingSchedule valve = soon_set(pump.valve, true);
  PendingSchedule speed = soon_set(pump.speed, 80);
  for (PendingSchedule* each : {&valve, &speed}) {
    const auto result = each->wait(std::chrono::minutes(1));
    ASSERT_TRUE(result) << each->text();
    EXPECT_TRUE(*result) << result->reason;
    EXPECT_GE(result->lateness, host::Duration(0));
  }
  EXPECT_EQ(server.tables().tab_bits[0], 1);
  EXPECT_EQ(server.tables().tab_registers[0], 800);
}

TEST_F(PumpClient, What_cannot_be_scheduled_says_why) {
  const auto later = std::chrono::steady_clock::now() + 30min;
  PendingSchedule offline = pump.valve.schedule(true, later);
  EXPECT_FALSE(offline.accepted());
  EXPECT_THAT(offline.text(), HasSubstr("connect()"));
  EXPECT_FALSE(offline.wait(soon)) << "at once";
  pump.connect();
  ASSERT_TRUE(pump.wait_online(soon));
  EXPECT_THAT(pump.speed.schedule(7000, later).text(), HasSubstr("0 to 6553.5 %"));
  EXPECT_THAT(pump.valve.schedule(true, later, 1s).text(),
              HasSubstr("only a coupler-node ends an output by itself"));
  EXPECT_THAT(pump.valve.schedule(true, later + 2h).text(), HasSubstr("an hour (3600 s) is the most"));
}

TEST_F(PumpClient, Disconnected_it_drives_nothing_any_more) {
  pump.connect();
  ASSERT_TRUE(pump.wait_online(soon));
  PendingSchedule pending = pump.valve.schedule(true, std::chrono::steady_clock::now() + 30min);
  ASSERT_TRUE(pending.accepted()) << pending.text();
  EXPECT_FALSE(pending.wait(1ms));
  pump.disconnect();
  const auto result = pending.wait(soon);
  ASSERT_TRUE(result);
  EXPECT_EQ(result->outcome, ScheduleResult::Outcome::cancelled);
  EXPECT_EQ(result->lateness, host::Duration(0)) << "only of what was carried out";
}

TEST_F(PumpClient, Each_point_can_be_met_with_its_name_and_type) {
  std::vector<std::string> names;
  pump.each_point([&](std::string_view name, const auto& point) {
    EXPECT_EQ(point.point().name, name);
    names.emplace_back(name);
  });
  EXPECT_THAT(names,
              ElementsAre("valve", "run", "running", "pressure", "temperatures", "starts", "speed", "label"));
}

}  // namespace
}  // namespace coupler::client
