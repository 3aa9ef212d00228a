// SPDX-License-Identifier: Apache-2.0
// What becomes of writes, seen by those who make them.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <array>
#include <new>

#include "test/fakes/map_builder.hpp"
#include "test/host/core/device_fixture.hpp"
#include "test/host/core/failing_heap.hpp"

namespace coupler::host {
namespace {

using codec::Type;
using std::chrono::milliseconds;
using testing::ElementsAre;
using Outcome = WriteResult::Outcome;

struct Results : WriteListener {
  std::vector<Outcome> outcomes;
  std::string text;
  void on_result(const WriteResult& result) override {
    outcomes.push_back(result.outcome);
    text = to_string(result);
  }
};

struct WriteResultsTest : test::DeviceTest {
  /// Four coils and four registers, side by side.
  void start_online(void (*adjust)(Map&) = nullptr, void (*adjust_point)(Point&) = nullptr) {
    const auto point = [&](Point& each) {
      if (adjust_point != nullptr) adjust_point(each);
    };
    for (std::uint16_t i = 0; i < 4; ++i) {
      builder.add(Table::coils, "k" + std::to_string(i), i, Type::BOOL, point);
      builder.add(Table::holding_registers, "r" + std::to_string(i), i, Type::UINT, point);
    }
    if (adjust != nullptr) adjust(builder.head());
    owned = builder.build();
    make_sink();
    make_engine(Verify::off, nullptr);
    run_for(milliseconds(50));
    device.requests.clear();
  }
  std::uint64_t written(Outcome outcome) const { return engine->statistics().written(outcome); }
  fakes::MapBuilder builder;
  Results results;
};

TEST_F(WriteResultsTest, A_write_that_is_acknowledged_is_ok) {
  start_online();
  push("k1", 1, &results);
  EXPECT_TRUE(results.outcomes.empty()) << "not before the device has said so";
  engine->step();
  EXPECT_THAT(results.outcomes, ElementsAre(Outcome::ok));
  EXPECT_EQ(written(Outcome::ok), 1U);
}

struct ThrowingListener : WriteListener {
  int calls = 0;
  void on_result(const WriteResult& /*result*/) override {
    ++calls;
    throw std::bad_alloc();
  }
};

TEST_F(WriteResultsTest, Each_write_has_one_result_though_the_listener_of_another_throws) {
  start_online();
  ThrowingListener throwing;
  Results third;
  push("r0", 7, &results);
  push("r1", 7, &throwing);
  push("r2", 7, &third);
  EXPECT_THROW(engine->step(), std::bad_alloc);
  engine->give_up("no memory");
  device.requests.clear();
  run_for(std::chrono::seconds(2));
  EXPECT_THAT(results.outcomes, ElementsAre(Outcome::ok));
  EXPECT_EQ(throwing.calls, 1);
  EXPECT_THAT(third.outcomes, ElementsAre(Outcome::lost));
  EXPECT_FALSE(device.requests.empty()) << "it is connected again";
  EXPECT_LT(device.requests.size(), 100U) << "and no write is due for ever";
}

struct Counted : WriteListener {
  int calls = 0;
  void on_result(const WriteResult& /*result*/) override { ++calls; }
};

TEST_F(WriteResultsTest, Each_write_has_one_result_though_there_is_no_memory_when_the_connection_ends) {
  bool has_failed = true;
  for (long after = 0; has_failed; ++after) {
    engine.reset();
    builder = fakes::MapBuilder();
    start_online([](Map& map) { map.on_reconnect = OnReconnect::restore; });
    std::array<Counted, 4> counted;
    push("k0", 1, &counted[0]);
    push("r0", 1, &counted[1]);
    push("r2", 1, &counted[2]);
    push("k3", 1, &counted[3]);
    device.next_errors.assign(1, TransportFailure{"reset"});
    has_failed = step_without_memory(after);
    device.next_errors.clear();
    run_for(milliseconds(200));
    for (const Counted& each : counted) EXPECT_EQ(each.calls, 1) << after;
  }
}

TEST_F(WriteResultsTest, A_write_that_is_refused_has_its_result_though_there_is_no_memory_for_its_text) {
  start_online();
  Counted counted;
  Write write;
  write.listener = &counted;
  test::fail_allocation();
  EXPECT_THROW(engine->refuse(write, "a text that needs memory"), std::bad_alloc);
  EXPECT_EQ(counted.calls, 1);
}

TEST(WriteTicket, It_has_its_result_though_there_is_no_memory_for_its_text) {
  WriteTicket ticket;
  test::fail_allocation();
  EXPECT_THROW(ticket.on_result({Outcome::dropped, std::nullopt, "a text that needs memory"}),
               std::bad_alloc);
  EXPECT_EQ(ticket.wait().outcome, Outcome::dropped);
}

TEST_F(WriteResultsTest, A_burst_becomes_one_request_and_each_write_has_its_result) {
  start_online();
  for (const char* name : {"r0", "r1", "r2", "r3"}) push(name, 7, &results);
  engine->step();
  EXPECT_THAT(device.requests, ElementsAre("write registers 0+4"));
  EXPECT_THAT(results.outcomes, ElementsAre(Outcome::ok, Outcome::ok, Outcome::ok, Outcome::ok));
}

TEST_F(WriteResultsTest, A_value_that_a_newer_one_overtakes_is_superseded) {
  start_online();
  Results newer;
  push("r0", 1, &results);
  push("r0", 2, &newer);
  EXPECT_THAT(results.outcomes, ElementsAre(Outcome::superseded));
  engine->step();
  EXPECT_THAT(newer.outcomes, ElementsAre(Outcome::ok));
  EXPECT_EQ((device.values[{Table::holding_registers, 0}]), 2);
}

TEST_F(WriteResultsTest, Of_a_number_that_waits_for_its_units_turn_the_newest_is_sent) {
  start_online();
  ASSERT_TRUE(shared->turns.try_take(this));
  push("r0", 1, &results);
  EXPECT_FALSE(engine->send_now());
  shared->turns.release();
  push("r0", 2);
  EXPECT_THAT(results.outcomes, ElementsAre(Outcome::superseded));
  engine->step();
  EXPECT_EQ((device.values[{Table::holding_registers, 0}]), 2);
  EXPECT_THAT(device.requests, ElementsAre("write register 0"));
}

TEST_F(WriteResultsTest, What_was_never_sent_is_not_lost) {
  for (const bool at_once : {true, false}) {
    for (const OnReconnect on_reconnect : {OnReconnect::drop, OnReconnect::restore}) {
      engine.reset();
      builder = fakes::MapBuilder();
      builder.head().on_reconnect = on_reconnect;
      start_online();
      results.outcomes.clear();
      device.fail_send = TransportFailure{"the gateway has closed the connection"};
      push("r0", 1, &results);
      EXPECT_FALSE(at_once && engine->send_now());
      engine->step();
      const bool is_kept = on_reconnect == OnReconnect::restore;
      EXPECT_THAT(results.outcomes, ElementsAre(is_kept ? Outcome::kept : Outcome::dropped));
      EXPECT_EQ(written(Outcome::lost), 0U);
      device.fail_send.reset();
      device.values.clear();
      run_for(milliseconds(500));
      EXPECT_EQ((device.values[{Table::holding_registers, 0}]), is_kept ? 1 : 0);
    }
  }
}

TEST_F(WriteResultsTest, After_a_write_that_could_not_be_sent_the_connection_is_used_by_nobody) {
  start_online();
  device.fail_send = TransportFailure{"only a part of the request could be sent"};
  push("r0", 1);
  EXPECT_FALSE(engine->send_now());
  device.fail_send.reset();
  push("r1", 1);
  EXPECT_FALSE(engine->send_now()) << "before the owner has closed it";
  EXPECT_EQ(device.values.count({Table::holding_registers, 1}), 0U);
}

TEST_F(WriteResultsTest, What_takes_a_read_before_waits_for_the_owner) {
  builder.add(Table::holding_registers, "bit", 9, Type::BOOL, [](Point& point) { point.format.bit = 3; });
  builder.head().limits.mask_write = false;
  start_online();
  push("bit", 1);
  EXPECT_FALSE(engine->send_now());
  EXPECT_TRUE(is_turn_free());
  EXPECT_TRUE(device.requests.empty());
  engine->step();
  EXPECT_THAT(device.requests, ElementsAre("read holding_registers 9+1", "write register 9"));
}

TEST_F(WriteResultsTest, An_exception_is_told_with_its_code_whatever_it_is) {
  start_online();
  for (const int code : {4, 5, 6, 0x60}) {
    device.next_errors.push_back(ExceptionReply{static_cast<modbus::Exception>(code)});
    push("k0", 1, &results);
    engine->step();
    EXPECT_NE(results.text.find(fmt::format("exception {:02X}", code)), std::string::npos) << results.text;
  }
  EXPECT_EQ(written(Outcome::exception), 4U);
  EXPECT_EQ(device.count("connect"), 0U) << "an exception is an answer: the connection stays";
}

TEST_F(WriteResultsTest, An_exception_of_the_gateway_takes_the_unit_offline_and_keeps_the_connection) {
  start_online();
  for (const int code : {0x0A, 0x0B}) {
    sink->online.clear();
    device.next_errors.push_back(ExceptionReply{static_cast<modbus::Exception>(code)});
    push("k0", 1, &results);
    engine->step();
    EXPECT_NE(results.text.find(fmt::format("exception {:02X}", code)), std::string::npos) << results.text;
    EXPECT_THAT(sink->online, ElementsAre(false));
    run_for(milliseconds(500));
    EXPECT_THAT(sink->online, ElementsAre(false, true));
    EXPECT_EQ(device.count("connect"), 0U);
  }
}

TEST_F(WriteResultsTest, What_is_acknowledged_is_so_also_if_the_unit_is_away_when_it_is_read_back) {
  start_online(nullptr, [](Point& point) { point.host.verify_write = point.address == 0; });
  sink->online.clear();
  device.refuses = [](const std::string& request) {
    return request.rfind("read", 0) == 0 ? std::optional(modbus::Exception::gateway_path_unavailable)
                                         : std::nullopt;
  };
  for (const char* name : {"k0", "k1"}) push(name, 1, &results);
  engine->step();
  EXPECT_THAT(results.outcomes, ElementsAre(Outcome::not_taken, Outcome::ok));
  EXPECT_THAT(sink->online, ElementsAre(false));
}

TEST_F(WriteResultsTest, A_device_that_refuses_several_at_once_gets_them_one_by_one) {
  start_online();
  device.next_errors.push_back(ExceptionReply{modbus::Exception::illegal_function});
  push("r0", 1, &results);
  push("r1", 2, &results);
  for (int i = 0; i < 3; ++i) engine->step();
  EXPECT_THAT(device.requests, ElementsAre("write registers 0+2", "write register 0", "write register 1"));
  EXPECT_THAT(results.outcomes, ElementsAre(Outcome::ok, Outcome::ok));
  push("r0", 3);
  push("r1", 4);
  engine->step();
  EXPECT_EQ(device.requests.back(), "write register 0") << "it is remembered while the connection lasts";
}

TEST_F(WriteResultsTest, One_address_that_the_device_does_not_have_costs_its_neighbours_nothing) {
  device.missing.insert({Table::holding_registers, 1});
  start_online();
  for (const char* name : {"r0", "r1", "r2"}) push(name, 7, &results);
  for (int i = 0; i < 4; ++i) engine->step();
  EXPECT_THAT(results.outcomes, ElementsAre(Outcome::ok, Outcome::exception, Outcome::ok));
}

TEST_F(WriteResultsTest, What_was_sent_when_the_link_broke_is_lost_and_what_waited_is_dropped) {
  start_online();
  device.next_errors.push_back(Timeout{milliseconds(3000)});
  push("r0", 1, &results);
  push("k0", 1, &results);
  engine->step();
  EXPECT_THAT(results.outcomes, ElementsAre(Outcome::lost, Outcome::dropped));
}

TEST_F(WriteResultsTest, Who_is_not_connected_hears_of_the_setting_that_would_help) {
  start_online();
  device.refuse_connect = NotConnected{"refused"};
  device.next_errors.push_back(TransportFailure{"reset"});
  run_for(milliseconds(99));
  push("r0", 1, &results);
  engine->step();
  EXPECT_THAT(results.text,
              testing::HasSubstr("with 'on_reconnect: restore' in the map it would be written"));
  Write click;
  click.point = static_cast<std::uint32_t>(find(owned->map(), "r0") - owned->map().points.data());
  click.until = clock.now() + milliseconds(3000);
  click.listener = &results;
  engine->push(click);
  engine->step();
  EXPECT_THAT(results.outcomes, ElementsAre(Outcome::dropped, Outcome::dropped));
  EXPECT_THAT(results.text, testing::HasSubstr("not connected"));
  EXPECT_THAT(results.text, testing::Not(testing::HasSubstr("restore"))) << "it would be too late";
}

TEST_F(WriteResultsTest, What_ends_by_itself_is_not_restored) {
  start_online([](Map& map) { map.on_reconnect = OnReconnect::restore; },
               [](Point& point) {
                 if (point.table == Table::coils) point.pulse = milliseconds(200);
               });
  push("k0", 1);
  engine->step();
  push("r0", 5);
  engine->step();
  device.next_errors.push_back(TransportFailure{"reset"});
  run_for(milliseconds(99));
  device.values.clear();
  push("k1", 1, &results);
  run_for(milliseconds(300));
  EXPECT_THAT(results.outcomes, ElementsAre(Outcome::dropped));
  EXPECT_THAT(results.text, testing::HasSubstr("a pulse is not written when the device is back"));
  EXPECT_EQ((device.values[{Table::coils, 0}]), 0);
  EXPECT_EQ((device.values[{Table::coils, 1}]), 0);
  EXPECT_EQ((device.values[{Table::holding_registers, 0}]), 5);
}

TEST_F(WriteResultsTest, With_restore_the_last_values_are_written_again_before_new_ones) {
  start_online([](Map& map) { map.on_reconnect = OnReconnect::restore; });
  push("r0", 5);
  engine->step();
  push("k0", 1);
  engine->step();
  device.next_errors.push_back(TransportFailure{"reset"});
  run_for(milliseconds(99));
  device.values.clear();
  push("r1", 6, &results);
  run_for(milliseconds(300));
  EXPECT_THAT(results.outcomes, ElementsAre(Outcome::kept));
  EXPECT_EQ((device.values[{Table::coils, 0}]), 1);
  EXPECT_EQ((device.values[{Table::holding_registers, 0}]), 5);
  EXPECT_EQ((device.values[{Table::holding_registers, 1}]), 6);
  EXPECT_EQ(device.count("write registers 0+2"), 1U) << "neighbours in one request";
  EXPECT_EQ(sink->reported("3 outputs were restored"), 1);
}

TEST_F(WriteResultsTest, A_read_that_a_write_overtakes_does_not_bring_the_old_value_back) {
  start_online();
  sink->values.clear();
  device.during_read = [this] { push("r1", 9); };
  clock.advance(milliseconds(100));
  engine->step();  // coils
  device.during_read = nullptr;
  EXPECT_EQ(sink->values["k1"].size(), 1U);
  engine->step();  // the write
  engine->step();  // registers
  EXPECT_THAT(sink->values["r1"], ElementsAre(9));
  clock.advance(milliseconds(100));
  engine->step();
  device.during_read = [this] { push("r1", 10); };
  engine->step();
  EXPECT_THAT(sink->values["r1"], ElementsAre(9)) << "9 was read after 10 was asked for";
  EXPECT_THAT(sink->values["r0"], ElementsAre(0, 0)) << "the others are as fresh as ever";
}

TEST_F(WriteResultsTest, A_value_that_does_not_read_back_is_told_with_both) {
  start_online(nullptr, [](Point& point) {
    point.host.verify_write = true;
    if (point.table == Table::holding_registers)
      point.read_address = static_cast<std::uint16_t>(point.address + 100);
  });
  device.values[{Table::holding_registers, 101}] = 0x0003;
  push("r1", 4, &results);
  push("k1", 1, &results);
  engine->step();
  engine->step();
  EXPECT_THAT(results.outcomes, ElementsAre(Outcome::not_taken, Outcome::ok));
  EXPECT_EQ(
      sink->reported("write to r1: not taken: acknowledged, but 0x0004 was written and 0x0003 reads back"),
      1);
}

TEST_F(WriteResultsTest, A_value_that_cannot_be_read_back_is_not_called_taken) {
  start_online(nullptr, [](Point& point) { point.host.verify_write = true; });
  device.missing.insert({Table::coils, 0});
  device.missing_for_reads_only = true;
  push("k0", 1, &results);
  engine->step();
  EXPECT_EQ(results.text,
            "not taken: acknowledged, but it cannot be read back: exception 02 (illegal data address)");
}

TEST_F(WriteResultsTest, A_value_that_is_none_of_its_point_is_refused) {
  start_online();
  Write wrong;
  wrong.listener = &results;
  engine->refuse(wrong, "300 is above 255");
  EXPECT_EQ(results.text, "refused: 300 is above 255");
  EXPECT_EQ(written(Outcome::refused), 1U);
}

}  // namespace
}  // namespace coupler::host
