// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/modbus/tcp_framer.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

namespace coupler::host {
namespace {

using Outcome = TcpFramer::Outcome;
using Adu = std::vector<std::uint8_t>;

/// Two registers are read from unit 5 with transaction 0x0102, unless a test sets another request.
struct TcpFramerTest : testing::Test {
  TcpFramerTest() { ask({3, 0, 10, 0, 2}); }
  void ask(const Adu& pdu) { request.set(0x0102, 5, pdu); }
  Outcome receive(const Adu& bytes) {
    std::copy(bytes.begin(), bytes.end(), framer.room().begin());
    framer.filled(bytes.size());
    return framer.next(request);
  }
  /// From the second reply on nothing may come before it.
  void receive_first_reply() { ASSERT_EQ(receive(reply), Outcome::reply); }
  Adu pdu() const { return {framer.pdu().begin(), framer.pdu().end()}; }
  std::string problem() const { return to_string(framer.problem()); }
  std::string noise() const { return framer.noise(request).value_or(BadFrame{}).why; }

  const Adu reply{1, 2, 0, 0, 0, 7, 5, 3, 4, 0x11, 0x22, 0x33, 0x44};
  TcpRequest request;
  TcpFramer framer;
};

TEST_F(TcpFramerTest, A_request_is_its_header_and_its_PDU) {
  EXPECT_THAT(Adu(request.adu().begin(), request.adu().end()),
              testing::ElementsAre(1, 2, 0, 0, 0, 6, 5, 3, 0, 10, 0, 2));
  EXPECT_EQ(request.transaction(), 0x0102);
  EXPECT_EQ(request.unit(), 5);
  EXPECT_EQ(request.function(), 3);
}

TEST_F(TcpFramerTest, A_reply_is_found_in_pieces_of_any_size) {
  for (std::size_t cut = 1; cut < reply.size(); ++cut) {
    SCOPED_TRACE(cut);
    const auto middle = reply.begin() + static_cast<std::ptrdiff_t>(cut);
    EXPECT_EQ(receive({reply.begin(), middle}), Outcome::nothing);
    ASSERT_EQ(receive({middle, reply.end()}), Outcome::reply);
    EXPECT_THAT(pdu(), testing::ElementsAre(3, 4, 0x11, 0x22, 0x33, 0x44));
  }
  EXPECT_EQ(framer.skipped(), 0U);
}

TEST_F(TcpFramerTest, Replies_to_two_requests_may_come_at_once) {
  TcpRequest second;
  second.set(0x0103, 5, Adu{5, 0, 1, 0xFF, 0});
  Adu both = reply;
  const Adu confirmed{1, 3, 0, 0, 0, 6, 5, 5, 0, 1, 0xFF, 0};
  both.insert(both.end(), confirmed.begin(), confirmed.end());
  ASSERT_EQ(receive(both), Outcome::reply);
  EXPECT_EQ(pdu().front(), 3);
  ASSERT_EQ(framer.next(second), Outcome::reply);
  EXPECT_EQ(pdu().front(), 5);
}

TEST_F(TcpFramerTest, What_is_wrong_with_a_reply_is_told) {
  receive_first_reply();
  struct Case {
    Adu bytes;
    const char* says;
  };
  const std::vector<Case> cases{
      {{1, 2, 0, 1, 0, 7, 5, 3, 4}, "not Modbus/TCP: 01 02 00 01"},
      {{1, 2, 0, 0, 0, 1, 5}, "not Modbus/TCP"},
      {{1, 2, 0, 0, 0, 255, 5}, "not Modbus/TCP"},
      {{'S', 'S', 'H', '-', '2', '.', '0'}, "not Modbus/TCP"},
      {{1, 1, 0, 0, 0, 7, 5, 3, 4}, "the reply to another request: transaction 257, where 258 was asked"},
      {{1, 2, 0, 0, 0, 7, 6, 3, 4},
       "unit 6 answered a request to unit 5; if the device is unit 6, set `unit: 6`"},
      {{1, 2, 0, 0, 0, 8, 5, 3, 4},
       "the byte count is 4, where the header leaves 5; asked 03 00 0a 00 02, got 01 02 00 00 00 08 05 03 "
       "04"},
      {{1, 2, 0, 0, 0, 5, 5, 3, 255}, "the byte count is 255, where the header leaves 2"},
      {{1, 2, 0, 0, 0, 3, 5, 3, 2}, "the byte count is 2, where the header leaves 0"},
      {{0x15, 3, 3, 0, 2, 2, 70}, "speaks TLS at this port"}};
  for (const Case& wrong : cases) {
    EXPECT_EQ(receive(wrong.bytes), Outcome::bad) << wrong.says;
    EXPECT_THAT(problem(), testing::HasSubstr(wrong.says));
    framer.reset();
    receive_first_reply();
  }
}

TEST_F(TcpFramerTest, A_function_that_was_not_asked_for_is_left_to_whoever_reads_the_reply) {
  ASSERT_EQ(receive({1, 2, 0, 0, 0, 3, 5, 4, 9}), Outcome::reply);
  EXPECT_THAT(pdu(), testing::ElementsAre(4, 9));
}

TEST_F(TcpFramerTest, An_exception_has_two_bytes_whatever_its_header_says) {
  for (const auto length : {std::uint8_t{3}, std::uint8_t{4}, std::uint8_t{254}}) {
    SCOPED_TRACE(int{length});
    framer.reset();
    ASSERT_EQ(receive({1, 2, 0, 0, 0, length, 5, 0x83, 2}), Outcome::reply);
    EXPECT_THAT(pdu(), testing::ElementsAre(0x83, 2));
    EXPECT_EQ(framer.is_trusted(), length == 3);
  }
  framer.reset();
  EXPECT_TRUE(framer.is_trusted());
  ASSERT_EQ(receive({1, 2, 0, 0, 0, 2, 5, 0x83}), Outcome::reply) << "one that ends before its code";
  EXPECT_THAT(pdu(), testing::ElementsAre(0x83));
}

TEST_F(TcpFramerTest, Before_the_first_reply_all_is_skipped_that_cannot_begin_one) {
  for (const Adu& greeting : {Adu{'\r', '\n'}, Adu{0}, Adu{0, 0, 0, 0, 0, 6, 1, 3, 0, 100, 0, 1}}) {
    framer.reset();
    const auto before = framer.skipped();
    Adu bytes = greeting;
    bytes.insert(bytes.end(), reply.begin(), reply.end());
    ASSERT_EQ(receive(bytes), Outcome::reply);
    EXPECT_EQ(framer.skipped() - before, greeting.size());
    EXPECT_EQ(pdu().back(), 0x44);
  }
}

TEST_F(TcpFramerTest, After_the_most_noise_that_is_skipped_a_reply_is_still_one) {
  for (int i = 0; i < 100; ++i) {
    const auto outcome = receive(Adu(200, 0xAA));
    if (outcome == Outcome::bad) break;
  }
  EXPECT_THAT(problem(), testing::HasSubstr("none of them begins a reply"));
  ASSERT_EQ(receive(reply), Outcome::reply);
}

TEST_F(TcpFramerTest, Before_the_first_reply_another_request_is_answered_to_be_told) {
  EXPECT_EQ(receive({9, 9, 0, 0, 0, 7, 5, 3, 4}), Outcome::bad);
  EXPECT_THAT(problem(), testing::HasSubstr("another request"));
  framer.reset();
  ask({5, 0, 1, 0xFF, 0});
  EXPECT_EQ(receive({9, 9, 0, 0, 0, 6, 5, 5, 0, 1, 0xFF, 0}), Outcome::bad);
  EXPECT_THAT(problem(), testing::HasSubstr("another request"));
}

TEST_F(TcpFramerTest, A_device_that_does_not_repeat_the_transaction_is_told_from_one_that_is_late) {
  const Adu other{0, 0, 0, 0, 0, 7, 5, 3, 4, 0x11, 0x22, 0x33, 0x44};
  EXPECT_EQ(receive(other), Outcome::bad);
  EXPECT_THAT(problem(), testing::HasSubstr("transaction 0, where 258 was asked. It is the first reply"));
  EXPECT_THAT(problem(), testing::HasSubstr("`limits: {transaction_ids: false}`"));
  EXPECT_TRUE(has_remedy(framer.problem()));
  framer.reset();
  EXPECT_EQ(receive({1, 1, 0, 0, 0, 7, 5, 3, 4}), Outcome::bad);
  EXPECT_FALSE(has_remedy(framer.problem())) << "it may be late, of a connection before";
  framer.reset();
  framer.give_up(request);
  EXPECT_EQ(receive(other), Outcome::bad);
  EXPECT_FALSE(has_remedy(framer.problem())) << "it may be late";
  framer.reset();
  receive_first_reply();
  EXPECT_EQ(receive(other), Outcome::bad);
  EXPECT_FALSE(has_remedy(framer.problem()));
}

TEST_F(TcpFramerTest, Without_transactions_a_reply_is_known_by_its_unit_function_and_length) {
  const Adu other{9, 9, 0, 0, 0, 7, 5, 3, 4, 0x11, 0x22, 0x33, 0x44};
  request.set(std::nullopt, 5, Adu{3, 0, 10, 0, 2});
  EXPECT_EQ(request.transaction(), 0);
  Adu greeted{'h', 'i'};
  greeted.insert(greeted.end(), other.begin(), other.end());
  for (const Adu& bytes : {other, greeted, reply}) {
    framer.reset();
    ASSERT_EQ(receive(bytes), Outcome::reply);
    EXPECT_THAT(pdu(), testing::ElementsAre(3, 4, 0x11, 0x22, 0x33, 0x44));
    EXPECT_TRUE(framer.is_trusted());
  }
  EXPECT_EQ(receive({9, 9, 0, 0, 0, 7, 6, 3, 4}), Outcome::bad);
  EXPECT_THAT(problem(), testing::EndsWith("unit 6 answered a request to unit 5"));
}

TEST_F(TcpFramerTest, Without_transactions_a_reply_that_is_awaited_no_more_ends_the_trust) {
  framer.give_up(request);
  EXPECT_TRUE(framer.is_trusted());
  request.set(std::nullopt, 5, Adu{3, 0, 10, 0, 2});
  framer.give_up(request);
  EXPECT_FALSE(framer.is_trusted());
  framer.reset();
  EXPECT_TRUE(framer.is_trusted());
}

TEST_F(TcpFramerTest, Without_transactions_two_replies_to_one_request_end_the_trust) {
  request.set(std::nullopt, 5, Adu{3, 0, 10, 0, 2});
  Adu twice = reply;
  twice.insert(twice.end(), reply.begin(), reply.end());
  ASSERT_EQ(receive(twice), Outcome::reply);
  EXPECT_FALSE(framer.is_trusted());
  framer.reset();
  ASSERT_EQ(receive({1, 2, 0, 0, 0, 3, 5, 0x83, 0x0B}), Outcome::reply);
  EXPECT_FALSE(framer.is_trusted()) << "the unit's own reply may follow";
  framer.reset();
  ASSERT_EQ(receive({1, 2, 0, 0, 0, 3, 5, 0x83, 2}), Outcome::reply);
  EXPECT_TRUE(framer.is_trusted());
}

TEST_F(TcpFramerTest, Without_transactions_noise_is_told_and_has_an_end) {
  request.set(std::nullopt, 5, Adu{3, 0, 10, 0, 2});
  EXPECT_EQ(receive({'l', 'o', 'g', 'i', 'n', ':', ' '}), Outcome::nothing);
  EXPECT_THAT(noise(), testing::HasSubstr("7 bytes have come"));
  auto outcome = Outcome::nothing;
  for (int i = 0; i < 100 && outcome == Outcome::nothing; ++i) outcome = receive(Adu(200, 0xFF));
  EXPECT_EQ(outcome, Outcome::bad);
}

TEST_F(TcpFramerTest, Unit_0_is_no_advice_where_a_gateway_says_it_of_all_units) {
  EXPECT_EQ(receive({1, 2, 0, 0, 0, 7, 0, 3, 4}), Outcome::bad);
  EXPECT_THAT(problem(),
              testing::HasSubstr("if the device takes requests to unit 0, set `unit: 0`; otherwise"));
}

TEST_F(TcpFramerTest, A_late_reply_to_a_request_that_was_given_up_is_skipped) {
  receive_first_reply();
  for (const int late : {1, 2, 3}) {  // the last one was not given up
    SCOPED_TRACE(late);
    framer.reset();
    receive_first_reply();
    framer.give_up(request);
    framer.give_up(request);
    Adu bytes{1, static_cast<std::uint8_t>(4 - late), 0, 0, 0, 7, 5, 3, 4, 0x55, 0x66, 0x77, 0x88};
    request.set(0x0104, 5, Adu{3, 0, 10, 0, 2});
    EXPECT_EQ(receive({bytes.begin(), bytes.begin() + 9}), late == 3 ? Outcome::bad : Outcome::nothing);
    if (late == 3) break;
    bytes.insert(bytes.end(), {1, 4, 0, 0, 0, 7, 5, 3, 4, 0x11, 0x22, 0x33, 0x44});
    ASSERT_EQ(receive({bytes.begin() + 9, bytes.end()}), Outcome::reply);
    EXPECT_THAT(pdu(), testing::ElementsAre(3, 4, 0x11, 0x22, 0x33, 0x44));
    EXPECT_EQ(noise(), "");
    ask({3, 0, 10, 0, 2});
  }
}

TEST_F(TcpFramerTest, Before_the_answer_to_a_wait_nothing_is_skipped) {
  ask({65, 1, 0, 0, 0, 9, 0, 0, 0, 0});
  EXPECT_EQ(receive({1, 3, 0, 0, 0, 4, 5, 1, 1, 1}), Outcome::bad) << "the reply to the read behind it";
  EXPECT_THAT(problem(), testing::HasSubstr("another request"));
}

TEST_F(TcpFramerTest, What_came_without_a_request_is_dropped_and_may_come_again) {
  receive_first_reply();
  const Adu beat{0, 0, 0, 0, 0, 2, 99, 8};
  std::copy(beat.begin(), beat.end(), framer.room().begin());
  framer.filled(beat.size());
  framer.drop();
  EXPECT_EQ(framer.skipped(), beat.size());
  Adu bytes = beat;
  bytes.insert(bytes.end(), reply.begin(), reply.end());
  EXPECT_EQ(receive(bytes), Outcome::reply);
  EXPECT_EQ(framer.skipped(), 2 * beat.size());
}

TEST_F(TcpFramerTest, Only_noise_is_told_as_that) {
  framer.drop();
  EXPECT_EQ(noise(), "");
  EXPECT_EQ(receive({'h', 'e', 'l', 'l', 'o', ' ', 'r', 'o', 'b', 'o', 't'}), Outcome::nothing);
  EXPECT_EQ(noise(), "11 bytes have come, and none of them begins a reply: 68 65 6c 6c 6f 20 72 6f 62");
  EXPECT_EQ(receive({1, 2}), Outcome::nothing);
  EXPECT_EQ(noise(), "") << "this may be the reply";
  framer.drop();
  EXPECT_EQ(noise(), "") << "it was for the request before";
}

TEST_F(TcpFramerTest, A_device_that_sends_noise_without_end_is_not_listened_to_for_ever) {
  const Adu noise(100, 0xFF);
  int pieces = 0;
  while (pieces < 1000 && receive(noise) == Outcome::nothing) ++pieces;
  EXPECT_LT(pieces, 200);
  EXPECT_THAT(problem(), testing::HasSubstr("none of them begins a reply"));
}

}  // namespace
}  // namespace coupler::host
