// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <cstdio>

#include "test/host/tools/look_fixture.hpp"

namespace coupler::tools::test {
namespace {

using codec::Type;
using modbus::Exception;
using testing::Each;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;
using State = Reading::State;

TEST(DeviceLooks, Every_point_is_read_by_as_few_requests_as_the_plan_has) {
  Looking looking(
      MapBuilder().coil("a", 0).coil("b", 1).input("door", 9).input_register("level", 3, Type::REAL));
  looking.device.values[{Table::coils, 1}] = 1;
  looking.device.values[{Table::input_registers, 4}] = 0x3F80;
  const Snapshot now = looking.look();
  EXPECT_TRUE(now.online());
  EXPECT_EQ(now.failed(), 0U);
  EXPECT_THAT(looking.of(now, "a").registers, ElementsAre(0));
  EXPECT_THAT(looking.of(now, "b").registers, ElementsAre(1));
  EXPECT_THAT(looking.of(now, "level").registers, ElementsAre(0, 0x3F80));
  EXPECT_THAT(looking.requests(), ElementsAre("connect", identity_question, "read coils 0+2",
                                              "read discrete_inputs 9+1", "read input_registers 3+2"));
}

TEST(DeviceLooks, It_writes_nothing_whatever_the_map_wants_at_a_connect) {
  MapBuilder builder;
  builder.coil("a", 0).holding("speed", 5);
  builder.head().on_reconnect = OnReconnect::restore;
  builder.head().on_shutdown = OnShutdown::safe;
  const WatchdogSequences::Write write{Table::holding_registers, 0x1000, 1};
  WatchdogSequences& watchdog = builder.head().coupler_watchdog;
  watchdog.timeout = std::chrono::milliseconds(100);
  watchdog.arm = watchdog.feed = watchdog.reset = {&write, 1};
  Looking looking(builder);
  looking.look();
  looking.device.next_errors = {host::TransportFailure{"gone"}};
  looking.look();
  looking.look();
  EXPECT_THAT(looking.requests(), Each(Not(StartsWith("write"))));
  EXPECT_TRUE(looking.device.senders.empty());
}

TEST(DeviceLooks, A_bad_address_costs_only_its_point) {
  MapBuilder builder;
  for (std::uint16_t i = 0; i < 8; ++i)
    builder.holding(std::vector<std::string_view>{"a", "b", "c", "d", "e", "f", "g", "h"}[i], i);
  Looking looking(builder);
  looking.device.missing.insert({Table::holding_registers, 5});
  const Snapshot now = looking.look();
  EXPECT_EQ(now.failed(), 1U);
  const Reading& bad = looking.of(now, "f");
  EXPECT_EQ(bad.state, State::failed);
  EXPECT_EQ(bad.why, "exception 02 (illegal data address)");
  EXPECT_EQ(bad.exception, Exception::illegal_data_address);
  EXPECT_TRUE(bad.registers.empty());
}

TEST(DeviceLooks, What_was_rejected_is_asked_for_in_parts_at_the_next_look) {
  Looking looking(MapBuilder().holding("a", 0).holding("b", 1).holding("c", 2).holding("d", 3));
  looking.device.missing.insert({Table::holding_registers, 3});
  looking.look();
  looking.requests();
  EXPECT_EQ(looking.look().failed(), 1U);
  EXPECT_THAT(looking.requests(), ElementsAre("read holding_registers 0+2", "read holding_registers 2+1",
                                              "read holding_registers 3+1"));
  looking.device.missing.clear();
  EXPECT_EQ(looking.look().failed(), 0U);
}

TEST(DeviceLooks, Points_that_share_a_bad_register_are_not_asked_for_one_by_one) {
  MapBuilder builder;
  for (std::uint8_t bit = 0; bit < 4; ++bit) {
    codec::Format format;
    format.bit = bit;
    builder.holding(std::vector<std::string_view>{"a", "b", "c", "d"}[bit], 7, format);
  }
  Looking looking(builder.holding("after", 8));
  looking.device.missing.insert({Table::holding_registers, 7});
  const Snapshot now = looking.look();
  EXPECT_EQ(now.failed(), 4U);
  EXPECT_EQ(looking.of(now, "after").state, State::good);
  EXPECT_THAT(looking.requests(), ElementsAre("connect", identity_question, "read holding_registers 7+2",
                                              "read holding_registers 7+1", "read holding_registers 8+1"));
}

TEST(DeviceLooks, Of_points_that_overlap_the_smaller_one_can_be_read) {
  Looking looking(MapBuilder().holding("both", 0, Type::DWORD).holding("low", 0));
  looking.device.missing.insert({Table::holding_registers, 1});
  const Snapshot now = looking.look();
  EXPECT_EQ(looking.of(now, "both").state, State::failed);
  EXPECT_EQ(looking.of(now, "low").state, State::good);
}

TEST(DeviceLooks, A_refused_hole_is_told_with_what_the_map_can_say_of_it) {
  MapBuilder builder;
  builder.holding("a", 0).holding("b", 4);
  builder.head().polling.register_continuous = true;
  Looking looking(builder);
  looking.device.missing.insert({Table::holding_registers, 2});
  const Snapshot now = looking.look();
  EXPECT_EQ(now.failed(), 0U);
  EXPECT_THAT(now.notes, ElementsAre(HasSubstr("unreadable: [{table: holding_registers, from: 1, to: 3}]")));
  EXPECT_EQ(looking.look().notes, now.notes);
}

TEST(DeviceLooks, A_failure_behind_one_address_is_singled_out_and_the_whole_asked_for_again) {
  Looking looking(MapBuilder().input("a", 0).input("b", 1).input("c", 2));
  bool fails = true;
  looking.device.refuses = [&fails](const std::string& request) -> std::optional<Exception> {
    const bool has_b = request == "read discrete_inputs 0+3" || request == "read discrete_inputs 1+2" ||
                       request == "read discrete_inputs 1+1";
    if (has_b && fails) return Exception::server_device_failure;
    return std::nullopt;
  };
  const Snapshot now = looking.look();
  EXPECT_EQ(now.failed(), 1U);
  EXPECT_EQ(looking.of(now, "b").exception, Exception::server_device_failure);
  EXPECT_TRUE(now.notes.empty());
  fails = false;
  looking.requests();
  EXPECT_EQ(looking.look().failed(), 0U);
  EXPECT_THAT(looking.requests(), ElementsAre("read discrete_inputs 0+3"));
}

TEST(DeviceLooks, A_function_that_the_device_does_not_have_is_asked_for_once_a_look) {
  Looking looking(MapBuilder().coil("a", 0).coil("b", 1).holding("c", 0));
  looking.device.refuses = [](const std::string& request) -> std::optional<Exception> {
    if (request.find("coils") != std::string::npos) return Exception::illegal_function;
    return std::nullopt;
  };
  const Snapshot now = looking.look();
  EXPECT_EQ(now.failed(), 2U);
  EXPECT_EQ(looking.device.count("read coils 0+2"), 1U);
  EXPECT_EQ(looking.of(now, "c").state, State::good);
}

TEST(DeviceLooks, What_the_map_says_cannot_be_read_is_no_failure) {
  MapBuilder builder;
  builder.coil("a", 0).command("horn", 1).holding("odd", 9);
  const TableRange hole{Table::holding_registers, modbus::Range::of(9, 1)};
  builder.head().unreadable = {&hole, 1};
  Looking looking(builder);
  const Snapshot now = looking.look();
  EXPECT_EQ(now.failed(), 0U);
  EXPECT_EQ(looking.of(now, "horn").state, State::not_asked);
  EXPECT_EQ(looking.of(now, "horn").why, "write-only");
  EXPECT_EQ(looking.of(now, "odd").why, "in what the map calls unreadable");
  EXPECT_THAT(looking.requests(), ElementsAre("connect", identity_question, "read coils 0+1"));
}

TEST(DeviceLooks, Only_what_is_chosen_is_read) {
  Looking looking(MapBuilder().coil("a", 0).coil("b", 1).coil("c", 2), {false, false, true});
  const Snapshot now = looking.look();
  ASSERT_EQ(now.readings.size(), 1U);
  EXPECT_EQ(now.readings[0].point, 2U);
  EXPECT_THAT(looking.requests(), ElementsAre("connect", identity_question, "read coils 2+1"));
}

TEST(DeviceLooks, An_output_is_read_where_it_reads_back) {
  MapBuilder builder;
  builder.holding("speed", 5);
  const MapPtr plain = builder.build();
  Point point = plain->map().points[0];
  point.read_address = 512;
  auto owned = std::make_shared<OwnedMap>();
  owned->finish(plain->map(), {point}, {});
  Looking looking{MapPtr(owned)};
  looking.device.values[{Table::holding_registers, 512}] = 44;
  EXPECT_THAT(looking.look().readings.at(0).registers, ElementsAre(44));
}

TEST(DeviceLooks, A_change_that_the_device_tells_is_shown_alone_and_at_once) {
  Looking looking(MapBuilder().coil("lamp", 3).coil("other", 4).holding("level", 0));
  looking.look();
  const auto tell = [&](const char* point, std::uint16_t level) {
    const plan::ReadSpan bit{
        Table::coils, read_range(looking.map().points[looking.index(point)]), {looking.index(point)}};
    looking.values.store(bit, std::array{level}, {looking.clock.now(), {}}, looking.clock.now());
    looking.snapshots.clear();
    looking.looks.on_told(looking.index(point));
  };
  tell("lamp", 1);
  ASSERT_EQ(looking.snapshots.size(), 1U);
  EXPECT_THAT(looking.of(looking.snapshots[0], "lamp").registers, ElementsAre(1));
  for (const char* point : {"lamp", "other", "level"})
    EXPECT_EQ(looking.of(looking.snapshots[0], point).changed, point == std::string("lamp")) << point;
  tell("lamp", 1);
  EXPECT_TRUE(looking.snapshots.empty()) << "it has that level already";
  tell("other", 1);
  EXPECT_FALSE(looking.of(looking.snapshots.at(0), "lamp").changed);
}

TEST(DeviceLooks, The_pauses_of_the_map_are_kept) {
  MapBuilder builder;
  builder.coil("a", 0).holding("b", 0);
  builder.head().limits.connect_delay = std::chrono::milliseconds(700);
  builder.head().limits.request_gap = std::chrono::milliseconds(40);
  Looking looking(builder);
  const host::Time start = looking.clock.now();
  looking.look();  // the identity, two reads
  EXPECT_EQ(looking.clock.now() - start, std::chrono::milliseconds(700 + 2 * 40));
}

TEST(DeviceLooks, A_device_that_is_not_there_has_no_values) {
  Looking looking(MapBuilder().coil("a", 0));
  looking.device.refuse_connect = host::NotConnected{"refused"};
  const Snapshot now = looking.look();
  EXPECT_EQ(to_string(*now.error), "refused");
  EXPECT_EQ(now.readings.at(0).state, State::failed);
  EXPECT_EQ(now.readings.at(0).why, "refused");
}

TEST(DeviceLooks, A_device_that_falls_silent_keeps_the_values_of_this_look_only) {
  Looking looking(MapBuilder().coil("a", 0).holding("b", 0));
  looking.look();
  looking.device.during_read = [&looking] {
    if (looking.device.requests.back() == "read holding_registers 0+1")
      looking.device.next_errors = {host::Timeout{std::chrono::milliseconds(9)},
                                    host::Timeout{std::chrono::milliseconds(9)}};  // another one's, too
  };
  Snapshot now = looking.look();
  EXPECT_EQ(to_string(*now.error), "no reply within 9 ms");
  EXPECT_EQ(looking.of(now, "a").state, State::good);
  EXPECT_EQ(looking.of(now, "b").why, "no reply within 9 ms");
  EXPECT_FALSE(looking.device.connected);
  looking.device.refuse_connect = host::NotConnected{"refused"};
  now = looking.look();
  EXPECT_EQ(looking.of(now, "a").state, State::failed);
  EXPECT_TRUE(looking.of(now, "a").registers.empty());
  looking.device.refuse_connect.reset();
  looking.device.during_read = nullptr;
  EXPECT_TRUE(looking.look().online());
}

TEST(DeviceLooks, A_request_without_a_reply_costs_its_own_points_if_others_have_one) {
  Looking looking(MapBuilder().coil("a", 0).holding("b", 0).holding("c", 1).holding("d", 9));
  looking.device.during_read = [&looking] {
    if (const std::string& asked = looking.device.requests.back();
        asked == "read holding_registers 0+2" || asked == "read holding_registers 1+1")
      looking.device.next_errors = {host::Timeout{std::chrono::milliseconds(9)}};
  };
  for (int i = 0; i < 3; ++i) {
    const Snapshot now = looking.look();
    EXPECT_TRUE(now.online());
    for (const char* good : {"a", "b", "d"}) EXPECT_EQ(looking.of(now, good).state, State::good) << good;
    EXPECT_THAT(looking.of(now, "c").why, HasSubstr("no reply within 9 ms"));
  }
  EXPECT_EQ(looking.device.count("read holding_registers 1+1"), 1U) << "it is asked again later";
}

TEST(DeviceLooks, A_device_that_closes_the_connection_after_each_reply_is_read_over_many) {
  Looking looking(MapBuilder().coil("a", 0).holding("b", 0).holding("c", 9));
  looking.device.during_read = [&looking] {
    if (const auto& all = looking.device.requests; all[all.size() - 2] != "connect")
      looking.device.next_errors = {host::TransportFailure{"closed", false, true}};
  };
  for (int i = 0; i < 3; ++i) {
    const Snapshot now = looking.look();
    EXPECT_TRUE(now.online());
    EXPECT_EQ(now.failed(), 0U);
  }
  EXPECT_EQ(looking.device.count("connect"), 10U) << "one for the identity, and one for each read";
}

TEST(DeviceLooks, A_device_that_closes_each_connection_without_a_reply_is_offline) {
  Looking looking(MapBuilder().coil("a", 0));
  looking.look();
  looking.device.during_read = [&looking] {
    looking.device.next_errors = {host::TransportFailure{"closed", false, true}};
  };
  EXPECT_FALSE(looking.look().online());
}

TEST(DeviceLooks, A_first_request_that_is_ignored_delays_no_look) {
  MapBuilder builder;
  builder.coil("a", 0).holding("b", 0);
  Looking looking(builder);
  looking.device.during_read = [&looking] {
    if (looking.device.requests.back() == "read coils 0+1")
      looking.device.next_errors = {host::Timeout{std::chrono::milliseconds(9)}};
  };
  const host::Time start = looking.clock.now();
  const Snapshot now = looking.look();
  EXPECT_TRUE(now.online());
  EXPECT_EQ(looking.of(now, "b").state, State::good);
  EXPECT_THAT(looking.of(now, "a").why, HasSubstr("no reply within 9 ms"));
  EXPECT_LT(looking.clock.now() - start, std::chrono::milliseconds(500)) << "a look is due each second";
}

TEST(DeviceLooks, A_device_that_stops_at_the_same_request_each_time_is_offline) {
  Looking looking(MapBuilder().coil("a", 0).holding("b", 0));
  looking.device.during_read = [&looking] {
    if (looking.device.requests.back() == "read holding_registers 0+1")
      looking.device.next_errors = {
          host::Timeout{std::chrono::milliseconds(9)},
          host::Timeout{std::chrono::milliseconds(9)}};  // of the next connection, too
  };
  const Snapshot now = looking.look();
  EXPECT_FALSE(now.online());
  EXPECT_EQ(looking.of(now, "a").state, State::good);
}

TEST(DeviceLooks, What_fails_and_what_is_too_long_are_asked_for_in_the_same_parts_each_time) {
  MapBuilder builder;
  for (std::uint16_t i = 0; i < 8; ++i)
    builder.holding(std::vector<std::string_view>{"a", "b", "c", "d", "e", "f", "g", "h"}[i], i);
  Looking looking(builder);
  looking.device.refuses = [](const std::string& request) -> std::optional<Exception> {
    unsigned first = 0;
    unsigned count = 0;
    if (std::sscanf(request.c_str(), "read holding_registers %u+%u", &first, &count) != 2)
      return std::nullopt;
    if (count > 5) return Exception::illegal_data_value;
    return first <= 2 && 2 < first + count ? std::optional(Exception::server_device_failure) : std::nullopt;
  };
  looking.look();
  const std::vector<std::string> notes = looking.look().notes;
  looking.requests();
  for (int i = 0; i < 3; ++i) {
    const Snapshot now = looking.look();
    EXPECT_EQ(now.failed(), 1U);
    EXPECT_EQ(now.notes, notes);
  }
  EXPECT_EQ(looking.device.count("read holding_registers 0+8"), 0U);
}

TEST(DeviceLooks, A_look_at_points_that_cannot_be_read_asks_for_nothing) {
  MapBuilder builder;
  builder.command("horn", 1);
  builder.head().verify = Verify::off;
  Looking looking(builder);
  const Snapshot now = looking.look();
  EXPECT_TRUE(now.online());
  EXPECT_EQ(looking.of(now, "horn").state, State::not_asked);
  EXPECT_THAT(looking.requests(), ElementsAre("connect"));
}

TEST(DeviceLooks, A_unit_that_its_gateway_cannot_reach_is_offline) {
  Looking looking(MapBuilder().coil("a", 0).coil("b", 1));
  looking.device.refuses = [](const std::string&) { return Exception::gateway_target_failed_to_respond; };
  const Snapshot now = looking.look();
  EXPECT_THAT(to_string(*now.error), HasSubstr("exception 0B"));
  EXPECT_THAT(looking.requests(), ElementsAre("connect", identity_question));
}

}  // namespace
}  // namespace coupler::tools::test
