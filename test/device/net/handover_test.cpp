// SPDX-License-Identifier: Apache-2.0
// Clients that one server lets go and another one goes on with.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>

#include "test/device/net/tcp_under_test.hpp"

namespace coupler::device {
namespace {

using testing::ElementsAreArray;

struct HandedOver : testing::Test {
  /// From one node to the other.
  void hand_over() {
    std::vector<OpenConnection> clients = one.tcp.release();
    EXPECT_EQ(one.tcp.size(), 0U);
    other.tcp.take_over(std::move(clients), TimePoint::clock::now());
    other.settle();
  }
  TcpUnderTest one;
  TcpUnderTest other;
};

TEST_F(HandedOver, A_client_notices_nothing) {
  Client client = one.connect();
  client.send(question(1));
  one.settle();
  EXPECT_THAT(client.received(), ElementsAreArray(answer_to(1)));
  hand_over();
  client.send(question(2));
  other.settle();
  EXPECT_THAT(client.received(), ElementsAreArray(answer_to(2)));
  EXPECT_EQ(other.tcp.size(), 1U);
}

TEST_F(HandedOver, One_whose_socket_would_wait_holds_up_nobody) {
  Client silent = one.connect();
  std::vector<OpenConnection> clients = one.tcp.release();
  ASSERT_EQ(clients.size(), 1U);
  ASSERT_EQ(::fcntl(clients[0].socket.get(), F_SETFL, 0), 0);
  other.tcp.take_over(std::move(clients), TimePoint::clock::now());
  Client client = other.connect();
  client.send(question(1));
  other.settle();
  EXPECT_THAT(client.received(), ElementsAreArray(answer_to(1)));
}

TEST_F(HandedOver, Half_a_request_is_completed_by_the_other_half) {
  Client client = one.connect();
  const Pdu whole = question(7);
  client.send(Pdu(whole.begin(), whole.begin() + 5));
  one.settle();
  hand_over();
  client.send(Pdu(whole.begin() + 5, whole.end()));
  other.settle();
  EXPECT_THAT(client.received(), ElementsAreArray(answer_to(7)));
}

TEST_F(HandedOver, Whole_requests_that_wait_behind_replies_are_answered_in_order_and_none_is_lost) {
  Client client = one.connect();
  // Until the kernel keeps no more replies for a client that does not read.
  const Pdu long_question = adu(0, pdu(3, {0, 125}));
  std::uint32_t asked = 0;
  while (asked < one.node.statistics.requests + 500 && client.send(long_question)) {
    ++asked;
    one.loop.run_once(std::chrono::milliseconds(0));
  }
  one.settle();
  const std::uint32_t before = one.node.statistics.requests;
  ASSERT_LT(before, asked);
  hand_over();
  std::size_t answered = 0;
  const TimePoint end = TimePoint::clock::now() + std::chrono::seconds(20);
  while (answered < asked * std::size_t{259} && TimePoint::clock::now() < end) {
    answered += client.received().size();
    other.loop.run_once(std::chrono::milliseconds(1));
  }
  other.settle();
  answered += client.received().size();
  EXPECT_EQ(answered, asked * std::size_t{259});
  EXPECT_EQ(one.node.statistics.requests + other.node.statistics.requests, asked);
}

TEST(HandingOver, Who_may_not_connect_any_more_is_not_taken_over) {
  TcpUnderTest one;
  TcpUnderTest other(8, AllowList({*parse_network("192.0.2.0/24")}));
  const Client client = one.connect();
  other.tcp.take_over(one.tcp.release(), TimePoint::clock::now());
  EXPECT_EQ(other.tcp.size(), 0U);
  EXPECT_EQ(other.node.statistics.refusals, 1U);
}

TEST(HandingOver, Who_has_written_an_output_feeds_the_watchdog_of_the_next) {
  TcpUnderTest one;
  one.node.watchdog = OutputWatchdog(Watchdog{std::chrono::hours(1), {}, {}});
  one.node.lines.outputs = {{0, {0, 0}}};
  Client client = one.connect();
  client.send(adu(1, pdu(5, {0, 0xFF00})));
  one.settle();
  const auto clients = one.tcp.release();
  ASSERT_EQ(clients.size(), 1U);
  EXPECT_TRUE(clients[0].has_written);
}

TEST(HandingOver, Who_has_written_an_output_is_named_by_address_certificate_and_role) {
  TcpUnderTest one;
  one.node.watchdog = OutputWatchdog(Watchdog{std::chrono::hours(1), {}, {}});
  one.node.lines.outputs = {{0, {0, 0}}};
  EXPECT_EQ(one.tcp.writers(), "");
  Client client = one.connect(5);
  const Client reader = one.connect(6);
  client.send(adu(1, pdu(5, {0, 0xFF00})));
  one.settle();
  EXPECT_EQ(one.tcp.writers(), "127.0.0.5");
  auto clients = one.tcp.release();
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(0x0A000006);
  for (OpenConnection& each : clients) {
    TlsPeer peer{{}, ShortText("cell1"), ShortText(each.has_written ? "operator" : "viewer")};
    std::memcpy(&peer.address, &address, sizeof address);
    each.tls = peer;
  }
  one.tcp.take_over(std::move(clients), TimePoint::clock::now());
  EXPECT_EQ(one.tcp.writers(), "'cell1' (10.0.0.6, operator)");
}

}  // namespace
}  // namespace coupler::device
