// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "coupler/modbus/frame.hpp"

namespace coupler::modbus {
namespace {

using testing::ElementsAre;
using testing::ElementsAreArray;
using Buffer = std::vector<std::uint8_t>;

using Outcome = Framer::Outcome;

Buffer copy(Bytes bytes) { return {bytes.begin(), bytes.end()}; }

/// An ADU with a PDU of `size` bytes, all of them `fill`.
Buffer adu(std::uint16_t transaction, std::size_t size, std::uint8_t fill = 3) {
  Buffer bytes(mbap_size + size, fill);
  put_header({transaction, 1, {}}, size, bytes.data());
  return bytes;
}

void feed(Framer& framer, Bytes bytes) {
  const auto room = framer.room();
  ASSERT_LE(bytes.size(), room.size());
  std::copy(bytes.begin(), bytes.end(), room.begin());
  framer.filled(bytes.size());
}

Outcome outcome_of(const Buffer& bytes) {
  Framer framer;
  feed(framer, bytes);
  return framer.next();
}

Buffer header(std::uint16_t protocol, std::uint16_t length) {
  Buffer bytes(6);
  put_u16(&bytes[2], protocol);
  put_u16(&bytes[4], length);
  return bytes;
}

TEST(Framer, A_frame_carries_transaction_unit_and_pdu) {
  Framer framer;
  feed(framer, Buffer{0x12, 0x34, 0, 0, 0, 6, 0x11, 3, 0, 1, 0, 2});
  ASSERT_EQ(framer.next(), Outcome::frame);
  EXPECT_EQ(framer.frame().transaction, 0x1234);
  EXPECT_EQ(framer.frame().unit, 0x11);
  EXPECT_THAT(copy(framer.frame().pdu), ElementsAre(3, 0, 1, 0, 2));
  EXPECT_EQ(framer.next(), Outcome::nothing);
  EXPECT_FALSE(framer.is_partial());
}

TEST(Framer, A_frame_is_found_however_it_is_cut) {
  const Buffer whole = adu(7, 100);
  for (std::size_t cut = 1; cut < whole.size(); ++cut) {
    Framer framer;
    feed(framer, Bytes(whole).first(cut));
    ASSERT_EQ(framer.next(), Outcome::nothing) << cut;
    ASSERT_TRUE(framer.is_partial());
    feed(framer, Bytes(whole).from(cut));
    ASSERT_EQ(framer.next(), Outcome::frame) << cut;
    ASSERT_THAT(copy(framer.frame().pdu), ElementsAreArray(copy(Bytes(whole).from(mbap_size))));
  }
}

TEST(Framer, Several_frames_in_one_read_are_found_in_order_and_the_rest_is_kept) {
  Buffer bytes;
  for (std::uint16_t i = 0; i < 4; ++i) {
    const Buffer one = adu(i, 5U + i);
    bytes.insert(bytes.end(), one.begin(), one.end());
  }
  const Buffer last = adu(4, 200);
  bytes.insert(bytes.end(), last.begin(), last.begin() + 50);

  Framer framer;
  feed(framer, bytes);
  for (std::uint16_t i = 0; i < 4; ++i) {
    ASSERT_EQ(framer.next(), Outcome::frame);
    EXPECT_EQ(framer.frame().transaction, i);
    EXPECT_EQ(framer.frame().pdu.size(), 5U + i);
  }
  EXPECT_EQ(framer.next(), Outcome::nothing);
  feed(framer, Bytes(last).from(50));
  ASSERT_EQ(framer.next(), Outcome::frame);
  EXPECT_EQ(framer.frame().pdu.size(), 200U);
}

TEST(Framer, The_shortest_and_the_longest_frame_fit) {
  for (const std::size_t size : {std::size_t{1}, max_pdu_size}) {
    Framer framer;
    feed(framer, adu(1, size));
    EXPECT_EQ(framer.next(), Outcome::frame);
    EXPECT_EQ(framer.frame().pdu.size(), size);
  }
}

TEST(Framer, There_is_always_room_when_a_frame_is_incomplete) {
  Framer framer;
  Buffer bytes = adu(1, 5);
  const Buffer longest = adu(2, max_pdu_size);
  bytes.insert(bytes.end(), longest.begin(), longest.end() - 13);
  feed(framer, bytes);
  ASSERT_EQ(framer.next(), Outcome::frame);
  ASSERT_EQ(framer.next(), Outcome::nothing);
  EXPECT_EQ(framer.room().size(), 13U);
}

TEST(Framer, A_length_below_2_or_above_254_closes_the_connection) {
  for (const int length : {0, 1, 255, 256, 0xFFFF})
    EXPECT_EQ(outcome_of(header(0, static_cast<std::uint16_t>(length))), Outcome::bad) << length;
  for (const int length : {2, 254})
    EXPECT_EQ(outcome_of(header(0, static_cast<std::uint16_t>(length))), Outcome::nothing) << length;
}

TEST(Framer, A_protocol_other_than_modbus_closes_the_connection) {
  for (const int protocol : {1, 0x100, 0xDEAD})
    EXPECT_EQ(outcome_of(header(static_cast<std::uint16_t>(protocol), 6)), Outcome::bad) << protocol;
}

}  // namespace
}  // namespace coupler::modbus
