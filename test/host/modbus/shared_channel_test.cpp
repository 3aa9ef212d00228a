// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/modbus/make_links.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <future>

#include "coupler/host/modbus/make_links.hpp"
#include "test/host/modbus/units_behind_gateway.hpp"

namespace coupler::host {
namespace {

using modbus::Range;
using modbus::WriteRequest;
using std::chrono::milliseconds;

bool never() { return false; }

TEST_F(SharedChannelTest, Units_behind_one_gateway_share_its_connection) {
  connect_all();
  for (int number = 1; number <= units; ++number) {
    ASSERT_TRUE(read(number));
    EXPECT_EQ(word, 100 * number);
    EXPECT_FALSE(unit(number).can_wait()) << "the others' requests would wait behind it";
  }
}

TEST_F(SharedChannelTest, Where_the_limits_allow_it_each_has_a_connection_of_its_own) {
  make(units);
  for (const auto& link : links) {
    ASSERT_TRUE(link->connect());
    EXPECT_TRUE(link->can_wait()) << "only a connection that is not shared can";
  }
}

TEST_F(SharedChannelTest, A_silent_unit_costs_the_others_time_but_not_their_connection) {
  patience[2] = milliseconds(200);
  connect_all();
  gateway.silent = 2;
  EXPECT_TRUE(std::holds_alternative<Timeout>(read(2).error()));
  unit(2).close();
  EXPECT_TRUE(read(1));
  EXPECT_TRUE(read(3));
}

TEST_F(SharedChannelTest, A_unit_that_is_away_leaves_the_connection_alone) {
  connect_all();
  gateway.away = 2;
  EXPECT_TRUE(is_unit_away(read(2).error()));
  EXPECT_TRUE(read(1));
}

TEST_F(SharedChannelTest, A_gateway_that_hangs_up_is_lost_for_all_until_each_has_connected_again) {
  connect_all();
  gateway.ends = true;
  EXPECT_FALSE(read(1));
  ASSERT_TRUE(unit(1).connect());
  EXPECT_TRUE(read(1));
  EXPECT_TRUE(std::holds_alternative<TransportFailure>(read(3).error()));
  ASSERT_TRUE(unit(3).connect());
  EXPECT_TRUE(read(3));
}

TEST_F(SharedChannelTest, A_write_is_not_sent_straight_through_while_another_unit_has_its_turn) {
  connect_all();
  const auto request = WriteRequest::register_value(1, 7);
  ASSERT_TRUE(unit(1).reserve());
  ASSERT_TRUE(unit(1).send(request));
  EXPECT_FALSE(unit(2).reserve());
  EXPECT_TRUE(unit(1).receive());
  ASSERT_TRUE(unit(2).reserve());
  ASSERT_TRUE(unit(2).send(request));
  EXPECT_TRUE(unit(2).receive());
}

TEST_F(SharedChannelTest, Who_closes_while_its_answer_is_to_come_gives_its_turn_back) {
  connect_all();
  ASSERT_TRUE(unit(1).send(WriteRequest::register_value(1, 7)));
  unit(1).close();
  EXPECT_TRUE(read(2));
}

TEST_F(SharedChannelTest, Who_closes_gives_back_a_turn_that_is_not_used) {
  connect_all();
  ASSERT_TRUE(unit(1).reserve());
  unit(1).close();
  ASSERT_TRUE(unit(2).reserve());
  unit(2).give_back();
  EXPECT_TRUE(read(3));
}

TEST_F(SharedChannelTest, Who_closes_does_not_wait_for_the_requests_of_others) {
  connect_all();
  const auto request = WriteRequest::register_value(1, 7);
  ASSERT_TRUE(unit(1).send(request));
  auto closing = std::async(std::launch::async, [this] { unit(2).close(); });
  EXPECT_EQ(closing.wait_for(std::chrono::seconds(20)), std::future_status::ready);
  EXPECT_TRUE(unit(1).receive());
}

TEST_F(SharedChannelTest, The_last_one_that_closes_ends_the_connection) {
  connect_all();
  for (const auto& link : links) link->close();
  Link another = make_link(owned[0]->map().connection);  // the gateway serves one at a time
  ASSERT_TRUE(another.connect());
  EXPECT_TRUE(another.read(Table::holding_registers, Range::of(1, 1), &word));
}

TEST_F(SharedChannelTest, A_read_that_waits_for_its_turn_makes_room_when_its_unit_is_woken) {
  connect_all();
  const auto request = WriteRequest::register_value(1, 7);
  ASSERT_TRUE(unit(1).send(request));
  auto waiting = std::async(std::launch::async, [this] { return unit(2).await_turn(Time::max()); });
  unit(2).wake();
  EXPECT_EQ(waiting.get(), Link::Turn::none);
  EXPECT_EQ(unit(2).await_turn(std::chrono::steady_clock::now() + milliseconds(1)), Link::Turn::none);
  EXPECT_TRUE(unit(1).receive());
  ASSERT_EQ(unit(2).await_turn(Time::max()), Link::Turn::read);
  EXPECT_FALSE(unit(3).reserve());
  EXPECT_TRUE(read(2));
  EXPECT_TRUE(read(3));
}

TEST_F(SharedChannelTest, Who_has_awaited_its_turn_to_write_is_the_next_to_write) {
  connect_all();
  const auto request = WriteRequest::register_value(1, 7);
  ASSERT_TRUE(unit(1).send(request));
  auto waiting = std::async(std::launch::async, [this] { unit(2).await_turn_to_write(never); });
  EXPECT_EQ(waiting.wait_for(milliseconds(20)), std::future_status::timeout);
  EXPECT_TRUE(unit(1).receive());
  waiting.get();
  EXPECT_FALSE(unit(3).reserve());
  ASSERT_TRUE(unit(2).send(request));
  EXPECT_TRUE(unit(2).receive());
  EXPECT_TRUE(read(3));
}

TEST_F(SharedChannelTest, Who_waits_to_write_gives_up_when_asked_to_and_is_woken) {
  connect_all();
  const auto request = WriteRequest::register_value(1, 7);
  ASSERT_TRUE(unit(1).send(request));
  std::atomic<bool> is_enough{false};
  auto waiting =
      std::async(std::launch::async, [&] { unit(2).await_turn_to_write([&] { return is_enough.load(); }); });
  unit(2).wake();
  EXPECT_EQ(waiting.wait_for(milliseconds(20)), std::future_status::timeout);
  is_enough = true;
  unit(2).wake();
  waiting.get();
  EXPECT_TRUE(unit(1).receive());
  EXPECT_TRUE(read(3));
}

TEST_F(SharedChannelTest, A_turn_that_is_given_back_is_for_others) {
  connect_all();
  ASSERT_TRUE(unit(1).reserve());
  EXPECT_FALSE(unit(2).reserve());
  unit(1).give_back();
  unit(2).await_turn_to_write(never);
  EXPECT_FALSE(unit(1).reserve());
  unit(2).give_back();
  unit(2).give_back();  // nothing is left
  EXPECT_TRUE(read(1));
}

TEST_F(SharedChannelTest, An_interrupt_ends_the_wait_for_a_turn_to_write) {
  connect_all();
  const auto request = WriteRequest::register_value(1, 7);
  ASSERT_TRUE(unit(1).send(request));
  auto waiting = std::async(std::launch::async, [this] { unit(2).await_turn_to_write(never); });
  unit(2).interrupt();
  waiting.get();
  EXPECT_FALSE(unit(2).send(request));
  EXPECT_TRUE(unit(1).receive());
  EXPECT_TRUE(read(3));
}

TEST_F(SharedChannelTest, A_gateway_that_takes_no_connection_any_more_is_lost_for_all_at_once) {
  const test::LoopbackSocket listener;
  listener.listen(0);  // the kernel takes one connection that nobody accepts
  port = listener.port();
  patience[1] = milliseconds(1000);  // it connects
  patience[2] = milliseconds(200);
  connect_all();
  EXPECT_TRUE(std::holds_alternative<Timeout>(read(1).error()));
  EXPECT_TRUE(std::holds_alternative<NotConnected>(read(2).error()));
  EXPECT_TRUE(std::holds_alternative<TransportFailure>(read(3).error()));
}

TEST_F(SharedChannelTest, An_interrupt_ends_the_wait_for_a_turn) {
  connect_all();
  const auto request = WriteRequest::register_value(1, 7);
  ASSERT_TRUE(unit(1).send(request));
  auto waiting = std::async(std::launch::async, [this] { return read(2); });
  unit(2).interrupt();
  EXPECT_FALSE(waiting.get());
  EXPECT_TRUE(unit(1).receive());
  EXPECT_TRUE(read(3));
}

TEST_F(SharedChannelTest, Who_writes_safe_values_has_every_turn_until_they_are_written) {
  connect_all();
  const auto request = WriteRequest::register_value(1, 7);
  ASSERT_TRUE(unit(1).send(request));
  unit(2).rank(Rank::safe);
  auto others = std::async(std::launch::async, [this] { return read(3); });
  EXPECT_TRUE(unit(1).receive());
  for (int i = 0; i < 3; ++i) {
    ASSERT_TRUE(unit(2).send(request));
    EXPECT_FALSE(unit(1).reserve());
    EXPECT_TRUE(unit(2).receive());
    EXPECT_EQ(others.wait_for(milliseconds(20)), std::future_status::timeout);
  }
  unit(2).rank(Rank::read);
  EXPECT_TRUE(others.get());
}

TEST_F(SharedChannelTest, A_unit_that_modbus_does_not_have_is_told) {
  owned.push_back(make_map(1));
  owned.push_back(make_map(250));
  links = make_links({owned[0]->map(), owned[1]->map()});
  ASSERT_TRUE(unit(1).connect());
  EXPECT_EQ(to_string(unit(2).connect().error()), "unit 250 is reserved; Modbus has units 0 to 247 and 255");
}

}  // namespace
}  // namespace coupler::host
