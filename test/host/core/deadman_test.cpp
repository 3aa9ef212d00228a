// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <future>
#include <new>
#include <utility>

#include "test/fakes/map_builder.hpp"
#include "test/host/core/device_fixture.hpp"

namespace coupler::host {
namespace {

using codec::Type;
using std::chrono::milliseconds;

struct DeadmanTest : test::DeviceTest {
  /// `names`: of the speeds.
  void start_online(const std::vector<NamedValue>& names = {}, OnReconnect on_reconnect = OnReconnect::drop) {
    fakes::MapBuilder builder;
    builder.head().on_reconnect = on_reconnect;
    const auto stop = builder.keep({1});
    const auto crawl = builder.keep({2});
    builder.add(Table::holding_registers, "speed", 5, Type::UINT, [&](Point& point) {
      point.access = Access::write;
      point.host.deadman = {milliseconds(200), stop};
      point.safe = Safe::on;
      point.safe_value = crawl;
      point.values = names;
    });
    builder.add(Table::holding_registers, "lamp", 20, Type::UINT, [&](Point& point) {
      point.access = Access::write;
      point.safe = Safe::on;
      point.safe_value = stop;
    });
    owned = builder.build();
    make_sink();
    make_engine(Verify::off, nullptr);
    run_for(milliseconds(10));
  }
  std::uint16_t speed() { return device.values[{Table::holding_registers, 5}]; }
  /// From now on each request gets this; what was asked is in device.requests.
  void refuse_all(modbus::Exception code) {
    device.requests.clear();
    device.refuses = [code](const std::string&) { return code; };
  }
  std::size_t writes() const { return device.count("write register 5"); }
};

TEST_F(DeadmanTest, A_command_that_falls_silent_is_replaced_once_and_reported) {
  start_online();
  push("speed", 500);
  run_for(milliseconds(190));
  EXPECT_EQ(speed(), 500);
  run_for(milliseconds(30));
  EXPECT_EQ(speed(), 1);
  run_for(milliseconds(1000));
  EXPECT_EQ(writes(), 2U);
  EXPECT_EQ(sink->reported("no message for speed in 200 ms: its deadman value 1 is written"), 1);
}

TEST_F(DeadmanTest, The_report_says_what_its_value_is_called) {
  const std::vector<NamedValue> names{{1, "crawl"}, {500, "run"}};
  start_online(names);
  push("speed", 500);
  run_for(milliseconds(300));
  EXPECT_EQ(sink->reported("no message for speed in 200 ms: its deadman value crawl is written"), 1);
}

TEST_F(DeadmanTest, Messages_keep_the_command) {
  start_online();
  for (int i = 0; i < 10; ++i) {
    push("speed", 500);
    run_for(milliseconds(150));
  }
  EXPECT_EQ(writes(), 10U);
}

TEST_F(DeadmanTest, A_message_whose_value_the_full_queue_drops_does_not_feed_it) {
  start_online();
  push("speed", 500);
  run_for(milliseconds(150));
  Write write;
  write.ordered = true;
  for (std::size_t i = 0; i < WriteQueue::capacity; ++i) {
    write.registers[0] = static_cast<std::uint16_t>(500 + i);
    engine->push(write);
  }
  ASSERT_EQ(engine->statistics().written(WriteResult::Outcome::dropped), 0U);
  clock.advance(milliseconds(100));
  engine->push(write);
  ASSERT_EQ(engine->statistics().written(WriteResult::Outcome::dropped), 1U);
  run_for(milliseconds(110));  // those in the queue fed it 210 ms ago
  EXPECT_EQ(speed(), 1);
}

TEST_F(DeadmanTest, The_next_message_arms_it_again) {
  start_online();
  for (int i = 0; i < 2; ++i) {
    push("speed", 500);
    run_for(milliseconds(300));
  }
  EXPECT_EQ(writes(), 4U);
}

TEST_F(DeadmanTest, Before_the_first_message_nothing_is_written) {
  start_online();
  run_for(milliseconds(1000));
  EXPECT_EQ(writes(), 0U);
}

TEST_F(DeadmanTest, A_command_that_fell_silent_while_the_device_was_away_is_replaced_when_it_is_back) {
  start_online();
  push("speed", 500);
  run_for(milliseconds(10));
  device.next_errors.push_back(TransportFailure{"reset"});
  push("speed", 501);
  device.refuse_connect = NotConnected{"refused"};
  run_for(milliseconds(1000));
  EXPECT_EQ(speed(), 500);
  device.refuse_connect.reset();
  run_for(milliseconds(2000));
  EXPECT_EQ(speed(), 1);
}

TEST_F(DeadmanTest, A_deadman_value_that_was_lost_is_written_again) {
  start_online();
  push("speed", 500);
  run_for(milliseconds(100));
  device.next_errors.push_back(Timeout{milliseconds(3000)});
  run_for(milliseconds(500));
  EXPECT_EQ(speed(), 1);
}

TEST_F(DeadmanTest, A_deadman_value_that_a_safe_value_supersedes_is_written_if_that_fails) {
  const Error rejected = ExceptionReply{modbus::Exception::illegal_data_value};
  const Error lost = Timeout{milliseconds(3000)};
  for (const Error& error : {rejected, lost}) {
    engine.reset();
    start_online();
    push("speed", 500);
    run_for(milliseconds(100));
    std::future<CallAnswer> asked;
    during_wait_for_turn([this] { run_for(milliseconds(200)); },
                         [&] {
                           asked = engine->make_safe();
                           device.next_errors.push_back(error);
                         });
    ASSERT_TRUE(asked.valid());
    EXPECT_FALSE(asked.get().success);
    run_for(milliseconds(2000));
    EXPECT_EQ(speed(), 1);
  }
}

struct ThrowingListener : WriteListener {
  void on_result(const WriteResult& /*result*/) override { throw std::bad_alloc(); }
};

TEST_F(DeadmanTest,
       A_deadman_value_that_a_safe_value_supersedes_is_written_if_a_listener_throws_before_that) {
  start_online();
  push("speed", 500);
  run_for(milliseconds(100));
  ThrowingListener throwing;
  std::future<CallAnswer> asked;
  during_wait_for_turn([this] { EXPECT_THROW(run_for(milliseconds(200)), std::bad_alloc); },
                       [&] {
                         push("lamp", 1, &throwing);
                         asked = engine->make_safe();
                       });
  engine->give_up("no memory");
  ASSERT_TRUE(asked.valid());
  EXPECT_FALSE(asked.get().success);
  run_for(milliseconds(2000));
  EXPECT_EQ(speed(), 1);
}

TEST_F(DeadmanTest, A_deadman_value_that_a_safe_value_supersedes_is_written_if_something_throws_during_that) {
  start_online();
  push("speed", 500);
  run_for(milliseconds(100));
  std::future<CallAnswer> asked;
  during_wait_for_turn([this] { EXPECT_THROW(run_for(milliseconds(200)), std::bad_alloc); },
                       [&] {
                         device.refuses = [this](const std::string&) -> std::optional<modbus::Exception> {
                           device.refuses = nullptr;
                           throw std::bad_alloc();
                         };
                         asked = engine->make_safe();
                       });
  engine->give_up("no memory");
  EXPECT_TRUE(is_turn_free()) << "other units wait";
  ASSERT_TRUE(asked.valid());
  EXPECT_FALSE(asked.get().success);
  run_for(milliseconds(2000));
  EXPECT_EQ(speed(), 1);
}

TEST_F(DeadmanTest, A_deadman_value_is_written_though_there_is_no_memory_at_first) {
  bool has_failed = true;
  for (long after = 0; has_failed; ++after) {
    engine.reset();
    start_online();
    push("speed", 500);
    run_for(milliseconds(100));
    clock.advance(milliseconds(200));
    Write write;
    write.point = 1;
    write.ordered = true;
    for (int i = 0; i < 8; ++i) engine->push(write);  // there is no room for another one
    has_failed = step_without_memory(after);
    run_for(milliseconds(2000));
    EXPECT_EQ(speed(), 1) << after;
  }
}

TEST_F(DeadmanTest, A_deadman_value_whose_unit_is_away_is_written_when_it_is_back) {
  for (const OnReconnect on_reconnect : {OnReconnect::drop, OnReconnect::restore}) {
    engine.reset();
    start_online({}, on_reconnect);
    push("speed", 500);
    run_for(milliseconds(100));
    sink->online.clear();
    refuse_all(modbus::Exception::gateway_target_failed_to_respond);
    run_for(milliseconds(4000));
    EXPECT_THAT(sink->online, testing::ElementsAre(false)) << "no answer of a gateway is one of its unit";
    EXPECT_LE(device.requests.size(), 8U) << "it is asked less and less often";
    EXPECT_EQ(speed(), 500);
    std::vector<std::uint16_t> written;
    device.refuses = [&](const std::string&) {
      written.push_back(speed());
      return std::nullopt;
    };
    run_for(milliseconds(10000));
    EXPECT_EQ(speed(), 1);
    EXPECT_EQ(std::count(written.begin() + 1, written.end(), 500), 0) << "500 was restored";
    device.refuses = nullptr;
  }
}

TEST_F(DeadmanTest, A_deadman_value_that_the_device_does_not_carry_out_is_tried_again_each_second) {
  start_online();
  push("speed", 500);
  run_for(milliseconds(100));
  refuse_all(modbus::Exception::server_device_busy);
  run_for(milliseconds(3000));
  EXPECT_EQ(writes(), 3U);
  EXPECT_EQ(sink->reported("no message for speed in 200 ms"), 1);
  device.refuses = nullptr;
  run_for(milliseconds(1000));
  EXPECT_EQ(speed(), 1);
}

TEST_F(DeadmanTest, A_deadman_value_that_the_device_never_takes_is_written_once) {
  start_online();
  push("speed", 500);
  run_for(milliseconds(100));
  refuse_all(modbus::Exception::illegal_data_value);
  run_for(milliseconds(3000));
  EXPECT_EQ(writes(), 1U);
}

}  // namespace
}  // namespace coupler::host
