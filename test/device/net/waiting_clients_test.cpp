// SPDX-License-Identifier: Apache-2.0
// Clients that wait for changes, beside others.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>

#include "test/device/net/tcp_under_test.hpp"

namespace coupler::device {
namespace {

using modbus::ChangesReply;
using std::chrono::milliseconds;
using testing::ElementsAreArray;
using testing::IsEmpty;

struct WaitingClients : testing::Test {
  static constexpr std::uint32_t epoch = 7;

  WaitingClients() { node.node.handler.tell_changes(epoch, TimePoint::clock::now()); }

  static Pdu request(std::uint16_t transaction, std::uint16_t wait = 30000, std::uint64_t seen = 0) {
    Pdu bytes(modbus::changes_request_size);
    modbus::build_changes_request({wait, epoch, seen}, bytes);
    return adu(transaction, bytes);
  }
  /// A client that waits.
  Client waiting() {
    Client client = node.connect();
    client.send(request(1));
    node.settle();
    EXPECT_THAT(client.received(), IsEmpty());
    return client;
  }
  void press_button() { node.node.lines.changes.push_back({0, true, TimePoint::clock::now()}); }
  /// What a node does after each wait of its loop.
  void turn() {
    const TimePoint now = TimePoint::clock::now();
    node.node.handler.tick(now);
    node.tcp.tick(now);
  }
  /// The answer to a wait, with the bytes behind it.
  static std::optional<ChangesReply> answer(const Pdu& bytes, std::uint16_t transaction = 1,
                                            Pdu* rest = nullptr) {
    if (bytes.size() < modbus::mbap_size || modbus::get_u16(bytes.data()) != transaction) return std::nullopt;
    const std::size_t size = modbus::mbap_size - 1U + modbus::get_u16(&bytes[4]);
    if (bytes.size() < size) return std::nullopt;
    if (rest != nullptr) rest->assign(bytes.begin() + static_cast<std::ptrdiff_t>(size), bytes.end());
    const auto pdu = modbus::Bytes(bytes).first(size).from(modbus::mbap_size);
    const auto reply = modbus::parse_changes_reply(pdu);
    return reply ? std::optional(*reply) : std::nullopt;
  }

  TcpUnderTest node;
};

TEST_F(WaitingClients, A_change_wakes_all_of_them_in_one_turn_and_nobody_else) {
  std::vector<Client> clients;
  for (int i = 0; i < 5; ++i) clients.push_back(waiting());
  Client other = node.connect();
  turn();
  for (Client& client : clients) EXPECT_THAT(client.received(), IsEmpty());
  press_button();
  turn();
  for (Client& client : clients) {
    const auto reply = answer(client.awaited());
    ASSERT_TRUE(reply.has_value());
    EXPECT_EQ(reply->count, 1);
  }
  EXPECT_THAT(other.received(), IsEmpty());
}

TEST_F(WaitingClients, Another_clients_write_is_such_a_change) {
  Client client = waiting();
  Client writer = node.connect();
  writer.send(adu(9, pdu(5, {3, 0xFF00})));
  node.settle();
  turn();
  const auto reply = answer(client.awaited());
  ASSERT_TRUE(reply.has_value());
  EXPECT_EQ(reply->changes[0].address, 3);
}

TEST_F(WaitingClients, A_frame_behind_a_wait_is_answered_after_it) {
  Client client = node.connect();
  Pdu both = request(1);
  const Pdu poll = question(2);
  both.insert(both.end(), poll.begin(), poll.end());
  client.send(both);
  node.settle();
  Pdu rest;
  EXPECT_TRUE(answer(client.awaited(), 1, &rest).has_value());
  EXPECT_THAT(rest, ElementsAreArray(answer_to(2)));
}

TEST_F(WaitingClients, Also_if_it_comes_later) {
  Client client = waiting();
  client.send(question(2));
  node.settle();
  Pdu rest;
  EXPECT_TRUE(answer(client.awaited(), 1, &rest).has_value());
  EXPECT_THAT(rest, ElementsAreArray(answer_to(2)));
}

TEST_F(WaitingClients, Half_a_frame_behind_a_wait_does_not_end_it) {
  Client client = waiting();
  const Pdu poll = question(2);
  client.send(Pdu(poll.begin(), poll.begin() + 5));
  node.settle();
  EXPECT_THAT(client.received(), IsEmpty());
}

TEST_F(WaitingClients, A_wait_that_is_over_is_answered_without_a_change) {
  Client client = node.connect();
  client.send(request(1, 1));
  node.settle();
  node.tcp.tick(TimePoint::clock::now() + milliseconds(1));
  const auto reply = answer(client.awaited());
  ASSERT_TRUE(reply.has_value());
  EXPECT_EQ(reply->count, 0);
}

TEST_F(WaitingClients, The_loop_sleeps_until_the_first_wait_is_over) {
  Client first = node.connect();
  Client second = node.connect();
  node.tcp.tick(TimePoint::clock::now());
  const TimePoint before = TimePoint::clock::now();
  first.send(request(1, 100));
  second.send(request(1, 20000));
  node.settle();
  const auto due = before + milliseconds(90);  // in no case later than a sweep of all connections
  EXPECT_GE(node.tcp.time_until_due(due), milliseconds(10));
  const auto over = TimePoint::clock::now() + milliseconds(100);
  EXPECT_EQ(node.tcp.time_until_due(over), milliseconds(0));
  node.tcp.tick(over);
  EXPECT_GT(node.tcp.time_until_due(due), milliseconds(100));
}

TEST_F(WaitingClients, The_reply_says_when_the_request_came_and_when_it_left) {
  Client client = node.connect();
  const auto sent = TimePoint::clock::now().time_since_epoch();
  client.send(request(1));
  node.settle();
  press_button();
  const auto pressed = TimePoint::clock::now().time_since_epoch();
  turn();
  const auto reply = answer(client.awaited());
  ASSERT_TRUE(reply.has_value());
  EXPECT_GE(reply->arrived, sent);
  EXPECT_LE(reply->arrived, pressed);
  EXPECT_GE(reply->replied, pressed);
  EXPECT_LE(reply->replied, TimePoint::clock::now().time_since_epoch());
}

TEST_F(WaitingClients, A_client_that_sends_no_more_gets_its_answer_and_the_end) {
  Client client = waiting();
  client.finish_sending();
  node.settle();
  EXPECT_TRUE(answer(client.awaited()).has_value());
  EXPECT_TRUE(client.is_closed());
}

TEST_F(WaitingClients, One_that_leaves_is_forgotten) {
  Client client = waiting();
  Client other = waiting();
  client.vanish();
  node.settle();
  EXPECT_EQ(node.tcp.size(), 1U);
  press_button();
  turn();
  EXPECT_TRUE(answer(other.awaited()).has_value());
}

TEST_F(WaitingClients, One_that_makes_room_is_forgotten) {
  std::vector<Client> clients;
  for (std::size_t i = 0; i < node.tcp.capacity(); ++i) clients.push_back(waiting());
  Client newcomer = waiting();
  EXPECT_EQ(node.node.statistics.evictions, 1U);
  press_button();
  turn();
  EXPECT_TRUE(answer(newcomer.awaited()).has_value());
}

TEST_F(WaitingClients, Who_is_handed_over_gets_its_answer_before) {
  Client client = waiting();
  const auto clients = node.tcp.release();
  EXPECT_TRUE(answer(client.awaited()).has_value());
  EXPECT_THAT(clients.at(0).unsent, IsEmpty());
  EXPECT_FALSE(client.is_closed());
}

TEST_F(WaitingClients, Who_waits_when_the_node_ends_is_told) {
  Client client = waiting();
  press_button();
  node.node.handler.take_news(TimePoint::clock::now());
  node.tcp.end_waits();
  const auto reply = answer(client.awaited());
  ASSERT_TRUE(reply.has_value());
  EXPECT_EQ(reply->count, 1);
}

TEST_F(WaitingClients, A_wait_behind_replies_that_nobody_reads_is_answered_when_they_are_read) {
  Client client = node.connect();
  // Until the kernel keeps no more replies for a client that does not read.
  const Pdu long_question = adu(0, pdu(3, {0, 125}));
  constexpr std::ptrdiff_t long_answer = 259;
  std::ptrdiff_t asked = 0;
  while (asked < std::ptrdiff_t{node.node.statistics.requests} + 500 && client.send(long_question)) {
    ++asked;
    node.loop.run_once(milliseconds(0));
  }
  ASSERT_TRUE(client.send(request(0xBEEF)));
  press_button();
  Pdu received;
  std::optional<ChangesReply> reply;
  for (int i = 0; i < 100000 && !reply; ++i) {
    node.loop.run_once(milliseconds(0));
    turn();
    const Pdu more = client.received();
    received.insert(received.end(), more.begin(), more.end());
    if (static_cast<std::ptrdiff_t>(received.size()) > asked * long_answer)
      reply = answer(Pdu(received.begin() + asked * long_answer, received.end()), 0xBEEF);
  }
  ASSERT_TRUE(reply.has_value());
  EXPECT_EQ(reply->count, 1);
}

}  // namespace
}  // namespace coupler::device
