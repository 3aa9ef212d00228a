// SPDX-License-Identifier: Apache-2.0
#include "coupler/modbus/changes.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "coupler/modbus/limits.hpp"

namespace coupler::modbus {
namespace {

using testing::ElementsAreArray;
using Pdu = std::vector<std::uint8_t>;

// The bytes are from Python: struct.pack(">BBHIQ", 65, 1, 1000, 0xA1B2C3D4, 0x0102030405060708)
const Pdu changes_request_bytes{0x41, 0x01, 0x03, 0xE8, 0xA1, 0xB2, 0xC3, 0xD4,
                                0x01, 0x02, 0x03, 0x04, 0x05, 0x06, 0x07, 0x08};

// struct.pack(">BBIqqQIB", 65, 1, 0xA1B2C3D4, 1234567890123456789, 1234567890123999999, 0x10203, 7, 2)
// + struct.pack(">BBHq", 2, 1, 300, 1234567890123450000) + struct.pack(">BBHq", 3, 4, 9, 5)
const Pdu changes_reply_bytes{0x41, 0x01, 0xA1, 0xB2, 0xC3, 0xD4, 0x11, 0x22, 0x10, 0xF4, 0x7D, 0xE9,
                              0x81, 0x15, 0x11, 0x22, 0x10, 0xF4, 0x7D, 0xF1, 0xCA, 0xFF, 0x00, 0x00,
                              0x00, 0x00, 0x00, 0x01, 0x02, 0x03, 0x00, 0x00, 0x00, 0x07, 0x02, 0x02,
                              0x01, 0x01, 0x2C, 0x11, 0x22, 0x10, 0xF4, 0x7D, 0xE9, 0x66, 0x90, 0x03,
                              0x04, 0x00, 0x09, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x05};

const Change edge{2, Change::Kind::on, 300, NodeTime(1234567890123450000)};
const Change cancelled{static_cast<std::uint8_t>(Reason::watchdog), Change::Kind::cancelled, 9, NodeTime(5)};

ChangesReply the_reply() {
  ChangesReply reply{0xA1B2C3D4, NodeTime(1234567890123456789), NodeTime(1234567890123999999), 0x10203, 7, 2,
                     {}};
  reply.changes[0] = edge;
  reply.changes[1] = cancelled;
  return reply;
}

Exception refusal_of_changes(const Pdu& pdu) {
  const auto parsed = parse_changes_request(pdu);
  return parsed ? Exception{} : parsed.error();
}

TEST(Changes, A_request_is_built_as_documented) {
  Pdu pdu(max_pdu_size);
  pdu.resize(build_changes_request({1000, 0xA1B2C3D4, 0x0102030405060708}, pdu));
  EXPECT_THAT(pdu, ElementsAreArray(changes_request_bytes));
}

TEST(Changes, A_request_is_parsed_as_documented) {
  const auto request = parse_changes_request(changes_request_bytes);
  ASSERT_TRUE(request);
  EXPECT_EQ(request->wait, 1000);
  EXPECT_EQ(request->epoch, 0xA1B2C3D4U);
  EXPECT_EQ(request->seen, 0x0102030405060708U);
}

TEST(Changes, A_request_of_another_length_or_version_or_with_too_long_a_wait_is_an_exception_03) {
  Pdu longer = changes_request_bytes;
  longer.push_back(0);
  EXPECT_EQ(refusal_of_changes(longer), Exception::illegal_data_value);
  EXPECT_EQ(refusal_of_changes({changes_request_bytes.begin(), changes_request_bytes.end() - 1}),
            Exception::illegal_data_value);
  EXPECT_EQ(refusal_of_changes({0x41}), Exception::illegal_data_value);
  Pdu newer = changes_request_bytes;
  newer[1] = 2;
  EXPECT_EQ(refusal_of_changes(newer), Exception::illegal_data_value);
  Pdu patient = changes_request_bytes;
  put_u16(&patient[2], 30000);
  EXPECT_EQ(refusal_of_changes(patient), Exception{});
  put_u16(&patient[2], 30001);
  EXPECT_EQ(refusal_of_changes(patient), Exception::illegal_data_value);
}

TEST(Changes, A_reply_is_built_as_documented) {
  Pdu pdu(max_pdu_size);
  pdu.resize(reply_changes(the_reply(), pdu));
  EXPECT_THAT(pdu, ElementsAreArray(changes_reply_bytes));
}

TEST(Changes, A_reply_is_parsed_as_documented) {
  const auto reply = parse_changes_reply(changes_reply_bytes);
  ASSERT_TRUE(reply);
  EXPECT_EQ(reply->epoch, 0xA1B2C3D4U);
  EXPECT_EQ(reply->arrived, NodeTime(1234567890123456789));
  EXPECT_EQ(reply->replied, NodeTime(1234567890123999999));
  EXPECT_EQ(reply->newest, 0x10203U);
  EXPECT_EQ(reply->lost, 7U);
  EXPECT_THAT(std::vector<Change>(reply->all().begin(), reply->all().end()),
              testing::ElementsAre(edge, cancelled));
}

TEST(Changes, The_longest_reply_has_eighteen_changes_and_fits_a_pdu) {
  ChangesReply reply;
  reply.count = max_changes;
  reply.changes.back() = edge;
  Pdu pdu(max_pdu_size);
  pdu.resize(reply_changes(reply, pdu));
  EXPECT_EQ(pdu.size(), 251U);
  const auto again = parse_changes_reply(pdu);
  ASSERT_TRUE(again);
  EXPECT_EQ(again->all()[17], edge);
}

TEST(Changes, A_reply_that_is_cut_off_too_long_or_of_another_version_is_none) {
  const auto wrong = [](const Pdu& pdu) {
    const auto reply = parse_changes_reply(pdu);
    return !reply && !reply.error().exception;
  };
  for (std::size_t size = 0; size < changes_reply_bytes.size(); ++size)
    EXPECT_TRUE(
        wrong({changes_reply_bytes.begin(), changes_reply_bytes.begin() + static_cast<std::ptrdiff_t>(size)}))
        << size;
  Pdu longer = changes_reply_bytes;
  longer.push_back(0);
  EXPECT_TRUE(wrong(longer));
  Pdu newer = changes_reply_bytes;
  newer[1] = 2;
  EXPECT_TRUE(wrong(newer));
  Pdu many(35 + 19 * 12, 0);
  many[0] = 0x41;
  many[1] = 1;
  many[34] = 19;
  EXPECT_TRUE(wrong(many)) << "longer than a PDU";
}

TEST(Changes, An_exception_is_told_as_such) {
  const auto reply = parse_changes_reply(Pdu{0xC1, 0x01});
  ASSERT_FALSE(reply);
  EXPECT_EQ(reply.error().exception, Exception::illegal_function);
}

TEST(Changes, A_kind_that_nobody_knows_is_no_bit) {
  Pdu pdu = changes_reply_bytes;
  pdu[36] = 2;
  EXPECT_FALSE(parse_changes_reply(pdu)->all()[0].is_bit());
  EXPECT_TRUE(parse_changes_reply(changes_reply_bytes)->all()[0].is_bit());
}

}  // namespace
}  // namespace coupler::modbus
