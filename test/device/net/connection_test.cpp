// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "test/device/net/tcp_under_test.hpp"

namespace coupler::device {
namespace {

using testing::ElementsAreArray;
using testing::IsEmpty;

void append(Pdu& to, const Pdu& bytes) { to.insert(to.end(), bytes.begin(), bytes.end()); }

class Connecting : public testing::Test {
 protected:
  TcpUnderTest node_;
};

TEST_F(Connecting, A_request_gets_its_reply) {
  Client client = node_.connect();
  client.send(question(0x1234));
  node_.settle();
  EXPECT_THAT(client.received(), ElementsAreArray(answer_to(0x1234)));
}

TEST_F(Connecting, A_request_that_comes_byte_by_byte_gets_its_reply) {
  Client client = node_.connect();
  for (const std::uint8_t byte : question(7)) {
    client.send({byte});
    node_.loop.run_once(std::chrono::milliseconds(50));
  }
  node_.settle();
  EXPECT_THAT(client.received(), ElementsAreArray(answer_to(7)));
}

TEST_F(Connecting, Pipelined_requests_are_answered_in_order) {
  Client client = node_.connect();
  Pdu questions, answers;
  for (std::uint16_t i = 0; i < 1000; ++i) {
    append(questions, question(i));
    append(answers, answer_to(i));
  }
  EXPECT_TRUE(client.send(questions));
  node_.settle();
  EXPECT_THAT(client.received(), ElementsAreArray(answers));
}

TEST_F(Connecting, The_longest_replies_to_a_full_buffer_of_requests_all_arrive) {
  Client client = node_.connect();
  Pdu questions;
  for (std::uint16_t i = 0; i < 21; ++i) append(questions, adu(i, pdu(1, {0, 2000})));
  EXPECT_TRUE(client.send(questions));
  node_.settle();
  EXPECT_EQ(client.received().size(), 21U * (modbus::mbap_size + 252));
}

TEST_F(Connecting, A_client_that_pipelines_takes_turns_with_the_others) {
  Client greedy = node_.connect();
  Client modest = node_.connect();
  Pdu questions;
  for (std::uint16_t i = 0; i < 1000; ++i) append(questions, question(i));
  greedy.send(questions);
  modest.send(question(1));
  const std::uint32_t before = node_.node.statistics.requests;
  while (modest.received().empty()) node_.loop.run_once(std::chrono::milliseconds(50));
  EXPECT_LT(node_.node.statistics.requests - before, 200U);
}

TEST_F(Connecting, A_bad_header_closes_the_connection_after_what_came_before_it_was_answered) {
  Client client = node_.connect();
  Pdu bytes = question(1);
  append(bytes, {0, 2, 0xDE, 0xAD, 0, 6, 1, 3, 0, 0, 0, 1});
  client.send(bytes);
  node_.settle();
  EXPECT_THAT(client.received(), ElementsAreArray(answer_to(1)));
  EXPECT_TRUE(client.is_closed());
  EXPECT_EQ(node_.node.statistics.bad_frames, 1U);
}

TEST_F(Connecting, A_request_hidden_inside_an_overlong_one_is_not_carried_out) {
  Client client = node_.connect();
  Pdu overlong = pdu(3, {0, 1});
  append(overlong, adu(2, pdu(6, {0, 0xBAD})));
  client.send(adu(1, overlong));
  node_.settle();
  EXPECT_THAT(client.received(), ElementsAreArray(adu(1, {0x83, 3})));
  client.send(question(3));
  node_.settle();
  EXPECT_THAT(client.received(), ElementsAreArray(answer_to(3)));
}

TEST_F(Connecting, A_client_that_ends_its_half_still_gets_its_replies) {
  Client client = node_.connect();
  client.send(question(1));
  client.finish_sending();
  node_.settle();
  EXPECT_THAT(client.received(), ElementsAreArray(answer_to(1)));
  EXPECT_TRUE(client.is_closed());
  EXPECT_EQ(node_.tcp.size(), 0U);
}

TEST_F(Connecting, A_client_that_vanishes_frees_its_place) {
  Client client = node_.connect();
  client.send({0, 1, 0});
  node_.settle();
  client.vanish();
  node_.settle();
  EXPECT_EQ(node_.tcp.size(), 0U);
}

TEST_F(Connecting, A_silent_client_is_welcome_but_a_frame_must_end_in_time_however_its_bytes_drip) {
  const TimePoint start = TimePoint::clock::now();
  Client silent = node_.connect();
  Client slow = node_.connect();
  for (int i = 0; i < 3; ++i) {
    slow.send({0});
    node_.settle();
  }
  node_.tcp.tick(start + std::chrono::seconds(4));
  EXPECT_EQ(node_.tcp.size(), 2U);
  node_.tcp.tick(TimePoint::clock::now() + Connection::timeout);
  EXPECT_TRUE(slow.is_closed());
  EXPECT_FALSE(silent.is_closed());
  EXPECT_EQ(node_.node.statistics.timeouts, 1U);
}

TEST_F(Connecting, A_client_that_reads_late_gets_every_reply_in_order) {
  Client late = node_.connect();
  constexpr std::uint16_t count = 9000;
  Pdu questions, answers, all_off(252);
  all_off[0] = 1;
  all_off[1] = 250;
  for (std::uint16_t i = 0; i < count; ++i) {
    append(questions, adu(i, pdu(1, {0, 2000})));
    append(answers, adu(i, all_off));
  }
  ASSERT_TRUE(late.send(questions));
  node_.settle();
  ASSERT_LT(node_.node.statistics.requests, count)
      << "the client's buffers hold everything: a longer test is needed";
  Pdu received;
  while (received.size() < answers.size() && !late.is_closed()) {
    append(received, late.received());
    node_.loop.run_once(std::chrono::milliseconds(1));
  }
  EXPECT_EQ(received, answers);
  EXPECT_EQ(node_.node.statistics.requests, count);
}

TEST_F(Connecting, A_client_that_never_reads_is_owed_little_and_dropped_and_the_others_notice_nothing) {
  Client rude = node_.connect();
  Client polite = node_.connect();
  Pdu burst;
  for (std::uint16_t i = 0; i < 100; ++i) append(burst, adu(i, pdu(1, {0, 2000})));
  std::uint32_t sent = 0;
  while (sent < 10000 && rude.send(burst)) {
    sent += 100;
    node_.loop.run_once(std::chrono::milliseconds(0));
  }
  node_.settle();
  EXPECT_LT(node_.node.statistics.requests, 9000U) << "it stopped reading from who does not read";
  polite.send(question(9));
  node_.settle();
  EXPECT_THAT(polite.received(), ElementsAreArray(answer_to(9)));

  node_.tcp.tick(TimePoint::clock::now() + Connection::timeout);
  EXPECT_EQ(node_.tcp.size(), 1U);
  EXPECT_FALSE(polite.is_closed());
}

/// Code that plays dead.
struct SilentHooks : Hooks {
  void put_new_values(Image&, Changes&) override {}
  bool accept(std::uint32_t, const std::uint16_t*) override { return true; }
  bool answers() override { return is_there; }

  bool is_there = true;
};

/// A server whose points such code is behind.
struct SilentNode {
  Client connect() {
    Client client(tcp.name());
    while (tcp.size() < 1) loop.run_once(std::chrono::milliseconds(50));
    return client;
  }

  NodeUnderTest node{fakes::MapBuilder().many(Table::holding_registers, 0, 2).build()};
  SilentHooks hooks;
  HookedPoints hooked{node.map, node.image, hooks};
  Handler handler{node.map,
                  Hardware(node.lines, nullptr, &hooked),
                  {node.image, node.statistics, node.watchdog, node.links, node.changes, node.schedule},
                  &node.clock};
  Server server{1, handler, node.statistics};
  FakeLog log;
  Loop loop;
  Listener listener = TcpUnderTest::listen({});
  TcpServer tcp{loop, listener, server, node.statistics, log, 8};
};

TEST(SilentCode, Closes_the_connection_of_a_client_that_asks_and_does_nothing) {
  SilentNode node;
  Client client = node.connect();
  client.send(question(1));
  while (node.node.statistics.requests < 1) node.loop.run_once(std::chrono::milliseconds(50));
  EXPECT_THAT(client.awaited(), ElementsAreArray(answer_to(1)));

  node.hooks.is_there = false;
  EXPECT_EQ(node.tcp.size(), 1U) << "it is asked when a client sends something";
  client.send(adu(2, pdu(6, {0, 7})));
  while (node.tcp.size() > 0) node.loop.run_once(std::chrono::milliseconds(50));
  EXPECT_THAT(client.awaited(), IsEmpty());
  EXPECT_TRUE(client.is_closed());
  EXPECT_EQ(node.node.statistics.requests, 1U);

  node.hooks.is_there = true;
  Client later = node.connect();
  later.send(question(3));
  while (node.node.statistics.requests < 2) node.loop.run_once(std::chrono::milliseconds(50));
  EXPECT_THAT(later.awaited(), ElementsAreArray(answer_to(3))) << "nothing was written";
}

}  // namespace
}  // namespace coupler::device
