// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "coupler/modbus/rtu_frame.hpp"

namespace coupler::modbus::rtu_test {
namespace {

using testing::ElementsAre;
using testing::ElementsAreArray;
using Buffer = std::vector<std::uint8_t>;
using Outcome = RtuFramer::Outcome;

constexpr std::uint8_t unit = 17;

Buffer copy(Bytes bytes) { return {bytes.begin(), bytes.end()}; }

Buffer frame(const Buffer& pdu, std::uint8_t of = unit) {
  Buffer bytes(max_rtu_size);
  bytes.resize(put_rtu_frame(of, pdu, bytes.data()));
  return bytes;
}

Buffer operator+(Buffer a, const Buffer& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

Outcome feed(RtuFramer& framer, Bytes bytes) {
  for (std::size_t at = 0; at < bytes.size();) {
    const auto room = framer.room();
    const Bytes part = bytes.sub(at, std::min(room.size(), bytes.size() - at));
    std::copy(part.begin(), part.end(), room.begin());
    framer.filled(part.size());
    at += part.size();
  }
  return framer.next();
}

const Buffer read{3, 0, 0x6B, 0, 3};
const Buffer values{3, 6, 0xAE, 0x41, 0x56, 0x52, 0x43, 0x40};
const Buffer write_one{6, 0, 1, 0, 3};

TEST(Crc16, Is_that_of_known_frames) {
  EXPECT_THAT(frame(read), ElementsAre(0x11, 3, 0, 0x6B, 0, 3, 0x76, 0x87));
  EXPECT_THAT(frame(values), ElementsAre(0x11, 3, 6, 0xAE, 0x41, 0x56, 0x52, 0x43, 0x40, 0x49, 0xAD));
  EXPECT_EQ(crc16(frame(read)), 0);
}

TEST(RtuFramer, The_reply_is_found_however_it_is_cut) {
  const Buffer reply = frame(values);
  for (std::size_t cut = 0; cut < reply.size(); ++cut) {
    RtuFramer framer;
    framer.expect(unit, read);
    ASSERT_EQ(feed(framer, Bytes(reply).first(cut)), Outcome::nothing) << cut;
    ASSERT_EQ(feed(framer, Bytes(reply).from(cut)), Outcome::reply) << cut;
    ASSERT_THAT(copy(framer.pdu()), ElementsAreArray(values));
  }
}

struct Exchange {
  const char* what;
  Buffer request, reply;
};

class Lengths : public testing::TestWithParam<Exchange> {};

TEST_P(Lengths, The_reply_ends_where_its_function_says) {
  const auto& [what, request, reply] = GetParam();
  const Buffer bytes = frame(reply);
  RtuFramer framer;
  framer.expect(unit, request);
  for (std::size_t i = 0; i + 1 < bytes.size(); ++i)
    ASSERT_EQ(feed(framer, {&bytes[i], 1}), Outcome::nothing) << what << ' ' << i;
  ASSERT_EQ(feed(framer, {&bytes.back(), 1}), Outcome::reply) << what;
  EXPECT_THAT(copy(framer.pdu()), ElementsAreArray(reply));
}

INSTANTIATE_TEST_SUITE_P(
    All, Lengths,
    testing::Values(
        Exchange{"coils", {1, 0, 0, 0, 10}, {1, 2, 0xFF, 3}},
        Exchange{"discrete inputs", {2, 0, 0, 0, 1}, {2, 1, 1}}, Exchange{"holding registers", read, values},
        Exchange{"the most registers", {4, 0, 0, 0, 125}, Buffer{4, 250} + Buffer(250, 0x11)},
        Exchange{"one coil", {5, 0, 1, 0xFF, 0}, {5, 0, 1, 0xFF, 0}},
        Exchange{"one register", write_one, write_one},
        Exchange{"a register that is stored otherwise", write_one, {6, 0, 1, 0, 2}},
        Exchange{"diagnostics", {8, 0, 0, 0xA5, 0x37, 1, 2}, {8, 0, 0, 0xA5, 0x37, 1, 2}},
        Exchange{"coils to write", {15, 0, 0, 0, 8, 1, 0xFF}, {15, 0, 0, 0, 8}},
        Exchange{"registers to write", {16, 0, 0, 0, 1, 2, 0, 7}, {16, 0, 0, 0, 1}},
        Exchange{"a file's record", {20, 7, 6, 0, 1, 0, 0, 0, 2}, {20, 6, 5, 6, 1, 2, 3, 4}},
        Exchange{"a mask", {22, 0, 4, 0, 0xF2, 0, 0x25}, {22, 0, 4, 0, 0xF2, 0, 0x25}},
        Exchange{"registers both ways", {23, 0, 3, 0, 1, 0, 14, 0, 1, 2, 0, 1}, {23, 2, 0, 9}},
        Exchange{"identification", {43, 14, 1, 0}, {43, 14, 1, 1, 0, 0, 2, 0, 3, 'a', 'b', 'c', 1, 0}},
        Exchange{"a function that is not known here", {65, 1, 2}, {65, 1, 2, 3, 4, 5}},
        Exchange{"an exception", read, {0x83, 2}}, Exchange{"an exception of another", {65, 1}, {0xC1, 1}}));

TEST(RtuFramer, No_damaged_reply_is_taken) {
  const Buffer reply = frame(values);
  for (std::size_t bit = 0; bit < 8 * reply.size(); ++bit) {
    Buffer damaged = reply;
    damaged[bit / 8] = static_cast<std::uint8_t>(damaged[bit / 8] ^ 1U << bit % 8);
    RtuFramer framer;
    framer.expect(unit, read);
    ASSERT_NE(feed(framer, damaged), Outcome::reply) << bit;
  }
}

TEST(RtuFramer, What_is_not_the_reply_is_skipped) {
  const std::pair<const char*, Buffer> before[] = {
      {"noise", {0, 0xFF, 0x55}},
      {"noise that looks like the beginning", {unit, 3, 200}},
      {"the reply of another unit", frame(values, 4)},
      {"the reply to another function", frame({4, 2, 0, 1})},
      {"a reply of another length", frame({3, 2, 0, 1})},
      {"a damaged reply", {unit, 3, 6, 1, 2, 3, 4, 5, 6, 7, 8}},
  };
  for (const auto& [what, bytes] : before) {
    RtuFramer framer;
    framer.expect(unit, read);
    ASSERT_NE(feed(framer, bytes), Outcome::reply) << what;
    ASSERT_EQ(feed(framer, frame(values)), Outcome::reply) << what;
    EXPECT_THAT(copy(framer.pdu()), ElementsAreArray(values)) << what;
  }
}

TEST(RtuFramer, The_confirmation_of_another_place_is_skipped) {
  const std::pair<Buffer, Buffer> writes[] = {{write_one, {6, 0, 2, 0, 3}},
                                              {{5, 0, 1, 0xFF, 0}, {5, 0, 2, 0xFF, 0}},
                                              {{16, 0, 0, 0, 1, 2, 0, 7}, {16, 0, 0, 0, 2}},
                                              {{22, 0, 4, 0, 0xF2, 0, 0x25}, {22, 0, 5, 0, 0xF2, 0, 0x25}}};
  for (const auto& [write, other] : writes) {
    RtuFramer framer;
    framer.expect(unit, write);
    EXPECT_NE(feed(framer, frame(other)), Outcome::reply) << int{write[0]};
  }
}

TEST(RtuFramer, What_is_skipped_is_counted) {
  RtuFramer framer;
  framer.expect(unit, read);
  feed(framer, frame(values, 4));
  EXPECT_EQ(framer.skipped(), 11U);
  EXPECT_TRUE(framer.holds_another_frame());
  feed(framer, Buffer{0xFF} + frame(values));
  EXPECT_EQ(framer.skipped(), 12U);
  framer.expect(unit, read);
  EXPECT_EQ(framer.skipped(), 0U);
  EXPECT_FALSE(framer.holds_another_frame());
  feed(framer, frame(read) + frame(values));
  EXPECT_EQ(framer.skipped(), 0U) << "an echo";
}

TEST(RtuFramer, Damage_is_told_apart_from_a_beginning) {
  RtuFramer framer;
  framer.expect(unit, read);
  EXPECT_EQ(framer.next(), Outcome::nothing);
  EXPECT_EQ(feed(framer, Buffer{0x55}), Outcome::damaged);
  EXPECT_EQ(feed(framer, Buffer{unit}), Outcome::nothing);
  EXPECT_EQ(feed(framer, Buffer{3, 6, 0, 0, 0, 0, 0, 0, 0, 0}), Outcome::damaged);
}

TEST(RtuFramer, A_request_begins_anew) {
  RtuFramer framer;
  framer.expect(unit, read);
  feed(framer, Bytes(frame(values)).first(5));
  framer.expect(unit, write_one);
  ASSERT_EQ(feed(framer, frame(write_one)), Outcome::reply);
  EXPECT_THAT(copy(framer.pdu()), ElementsAreArray(write_one));
}

TEST(RtuFramer, There_is_always_room_and_the_reply_is_found_behind_any_noise) {
  RtuFramer framer;
  framer.expect(unit, read);
  for (int i = 0; i < 100; ++i)
    ASSERT_NE(feed(framer, Buffer(100, static_cast<std::uint8_t>(unit))), Outcome::reply);
  ASSERT_FALSE(framer.room().empty());
  EXPECT_EQ(feed(framer, frame(values)), Outcome::reply);
}

/// A line that hands back what is sent.
class Echo : public testing::Test {
 protected:
  Outcome ask(const Buffer& request, const Buffer& bytes) {
    framer_.expect(unit, request);
    return feed(framer_, bytes);
  }
  RtuFramer framer_;
};

TEST_F(Echo, It_is_skipped_and_known_from_then_on) {
  EXPECT_EQ(framer_.has_echo(), std::nullopt);
  const Buffer echo = frame(read);
  for (std::size_t cut = 1; cut <= echo.size(); ++cut)
    ASSERT_EQ(ask(read, copy(Bytes(echo).first(cut))), Outcome::nothing) << cut;
  EXPECT_EQ(framer_.has_echo(), true);
  EXPECT_EQ(feed(framer_, frame(values)), Outcome::reply);

  EXPECT_EQ(ask(write_one, frame(write_one)), Outcome::nothing) << "what is sent is no reply";
  EXPECT_EQ(feed(framer_, frame(write_one)), Outcome::reply);
  EXPECT_EQ(ask(write_one, frame(write_one) + frame(write_one)), Outcome::reply);
}

TEST_F(Echo, Of_a_write_of_several_it_is_not_the_reply) {
  const Buffer write{16, 0, 0, 0, 1, 2, 0, 7};
  EXPECT_EQ(ask(write, frame(write)), Outcome::nothing);
  EXPECT_EQ(feed(framer_, frame({16, 0, 0, 0, 1})), Outcome::reply);
}

TEST_F(Echo, A_reply_that_is_also_the_beginning_of_its_request_is_taken_where_there_is_none) {
  Buffer reply{16, 0, 0, 0, 1};
  while (frame(reply)[6] != 2) ++reply[2];  // the number of bytes that one register has
  const Buffer write = reply + Buffer{2, frame(reply)[7], 0};
  Buffer beginning = frame(write);
  beginning.resize(frame(reply).size());
  ASSERT_EQ(beginning, frame(reply));

  EXPECT_EQ(ask(read, frame(values)), Outcome::reply);
  EXPECT_EQ(ask(write, frame(reply)), Outcome::reply);
  EXPECT_EQ(ask(read, frame(read) + frame(values)), Outcome::reply) << "with an echo";
  EXPECT_EQ(ask(write, frame(reply)), Outcome::nothing) << "its beginning";
}

TEST_F(Echo, A_line_without_it_answers_a_write_with_the_same_bytes) {
  EXPECT_EQ(ask(read, frame(values)), Outcome::reply);
  EXPECT_EQ(framer_.has_echo(), false);
  EXPECT_EQ(ask(write_one, frame(write_one)), Outcome::reply);
  EXPECT_EQ(framer_.has_echo(), false);
}

TEST_F(Echo, Nothing_is_concluded_from_a_reply_that_may_be_one) {
  EXPECT_EQ(ask(write_one, frame(write_one)), Outcome::reply);
  EXPECT_EQ(framer_.has_echo(), std::nullopt);
}

TEST_F(Echo, Another_line_may_have_none) {
  ask(read, frame(read) + frame(values));
  framer_.reset();
  EXPECT_EQ(framer_.has_echo(), std::nullopt);
  EXPECT_EQ(ask(write_one, frame(write_one)), Outcome::reply);
}

}  // namespace
}  // namespace coupler::modbus::rtu_test
