// SPDX-License-Identifier: Apache-2.0
#include "coupler/modbus/scheduled_output.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

namespace coupler::modbus {
namespace {

using std::chrono::milliseconds;
using testing::ElementsAre;
using testing::ElementsAreArray;
using Pdu = std::vector<std::uint8_t>;

constexpr NodeTime due{1234567890123456789};

// The bytes are from Python:
// struct.pack(">BBBIqIBHHB", 66, 1, 1, 0xA1B2C3D4, 1234567890123456789, 200, 1, 258, 10, 2) + the bits
const Pdu coils_bytes{0x42, 0x01, 0x01, 0xA1, 0xB2, 0xC3, 0xD4, 0x11, 0x22, 0x10, 0xF4, 0x7D, 0xE9, 0x81,
                      0x15, 0x00, 0x00, 0x00, 0xC8, 0x01, 0x01, 0x02, 0x00, 0x0A, 0x02, 0x45, 0x02};
// struct.pack(">BBBIqIBHHB", 66, 1, 1, 0xA1B2C3D4, 1234567890123456789, 0, 3, 258, 2, 4)
// + struct.pack(">HH", 0x1234, 0xFFFE)
const Pdu registers_bytes{0x42, 0x01, 0x01, 0xA1, 0xB2, 0xC3, 0xD4, 0x11, 0x22, 0x10,
                          0xF4, 0x7D, 0xE9, 0x81, 0x15, 0x00, 0x00, 0x00, 0x00, 0x03,
                          0x01, 0x02, 0x00, 0x02, 0x04, 0x12, 0x34, 0xFF, 0xFE};
// struct.pack(">BBBIH", 66, 1, 2, 0xA1B2C3D4, 513)
const Pdu cancel_bytes{0x42, 0x01, 0x02, 0xA1, 0xB2, 0xC3, 0xD4, 0x02, 0x01};
// struct.pack(">BBBIqBHH", 66, 1, 3, 0xA1B2C3D4, 1234567890123456789, 3, 258, 10)
const Pdu cancel_from_bytes{0x42, 0x01, 0x03, 0xA1, 0xB2, 0xC3, 0xD4, 0x11, 0x22, 0x10,
                            0xF4, 0x7D, 0xE9, 0x81, 0x15, 0x03, 0x01, 0x02, 0x00, 0x0A};
// struct.pack(">BBHqq", 66, 1, 513, 1234567890123456789, 1234567890123999999)
const Pdu schedule_reply_bytes{0x42, 0x01, 0x02, 0x01, 0x11, 0x22, 0x10, 0xF4, 0x7D, 0xE9,
                               0x81, 0x15, 0x11, 0x22, 0x10, 0xF4, 0x7D, 0xF1, 0xCA, 0xFF};

ScheduleOutput at(milliseconds duration) {
  ScheduleOutput output;
  output.epoch = 0xA1B2C3D4;
  output.due = due;
  output.duration = duration;
  output.range = Range::of(258, 1);
  return output;
}

Pdu bytes_of(const ScheduleRequest& request) { return {request.pdu().begin(), request.pdu().end()}; }

Exception why_refused(const Pdu& pdu) {
  const auto parsed = parse_schedule_request(pdu);
  return parsed ? Exception{} : parsed.error();
}

Pdu with(Pdu pdu, std::size_t at, int byte) {
  pdu[at] = static_cast<std::uint8_t>(byte);
  return pdu;
}

TEST(ScheduledOutput, Coils_are_scheduled_as_documented) {
  const std::vector<std::uint16_t> bits{1, 0, 1, 0, 0, 0, 1, 0, 0, 1};
  EXPECT_THAT(bytes_of(ScheduleRequest::coils(at(milliseconds(200)), bits)), ElementsAreArray(coils_bytes));
  const auto parsed = parse_schedule_request(coils_bytes);
  ASSERT_TRUE(parsed);
  const auto& output = std::get<ScheduleOutput>(*parsed);
  EXPECT_EQ(output.epoch, 0xA1B2C3D4U);
  EXPECT_EQ(output.due, due);
  EXPECT_EQ(output.duration, milliseconds(200));
  EXPECT_EQ(output.table, Function::read_coils);
  EXPECT_EQ(output.range, Range::of(258, 10));
  EXPECT_THAT(Pdu(output.values.begin(), output.values.end()), ElementsAre(0x45, 0x02));
}

TEST(ScheduledOutput, Registers_are_scheduled_as_documented) {
  EXPECT_THAT(
      bytes_of(ScheduleRequest::registers(at(milliseconds(0)), std::vector<std::uint16_t>{0x1234, 0xFFFE})),
      ElementsAreArray(registers_bytes));
  const auto parsed = parse_schedule_request(registers_bytes);
  ASSERT_TRUE(parsed);
  const auto& output = std::get<ScheduleOutput>(*parsed);
  EXPECT_EQ(output.table, Function::read_holding_registers);
  EXPECT_EQ(output.range, Range::of(258, 2));
  EXPECT_THAT(Pdu(output.values.begin(), output.values.end()), ElementsAre(0x12, 0x34, 0xFF, 0xFE));
}

TEST(ScheduledOutput, A_cancellation_is_as_documented) {
  EXPECT_THAT(bytes_of(ScheduleRequest::cancel({0xA1B2C3D4, 513})), ElementsAreArray(cancel_bytes));
  const auto parsed = parse_schedule_request(cancel_bytes);
  ASSERT_TRUE(parsed);
  EXPECT_EQ(std::get<CancelOutput>(*parsed).epoch, 0xA1B2C3D4U);
  EXPECT_EQ(std::get<CancelOutput>(*parsed).number, 513);
}

TEST(ScheduledOutput, A_cancellation_of_many_is_as_documented) {
  const CancelOutputs wanted{0xA1B2C3D4, due, Function::read_holding_registers, Range::of(258, 10)};
  EXPECT_THAT(bytes_of(ScheduleRequest::cancel_from(wanted)), ElementsAreArray(cancel_from_bytes));
  const auto parsed = parse_schedule_request(cancel_from_bytes);
  ASSERT_TRUE(parsed);
  const auto& cancel = std::get<CancelOutputs>(*parsed);
  EXPECT_EQ(cancel.epoch, 0xA1B2C3D4U);
  EXPECT_EQ(cancel.from, due);
  EXPECT_EQ(cancel.table, Function::read_holding_registers);
  EXPECT_EQ(cancel.range, Range::of(258, 10));
}

TEST(ScheduledOutput, A_cancellation_of_many_has_up_to_65535_addresses_and_any_time) {
  const CancelOutputs all{7, NodeTime::min(), Function::read_coils, Range::of(1, 65535)};
  const auto parsed = parse_schedule_request(ScheduleRequest::cancel_from(all).pdu());
  ASSERT_TRUE(parsed);
  EXPECT_EQ(std::get<CancelOutputs>(*parsed).range, all.range);
  EXPECT_EQ(std::get<CancelOutputs>(*parsed).from, NodeTime::min());
}

TEST(ScheduledOutput, The_reply_is_as_documented) {
  Pdu pdu(max_pdu_size);
  pdu.resize(reply_schedule({513, due, NodeTime(1234567890123999999)}, pdu));
  EXPECT_THAT(pdu, ElementsAreArray(schedule_reply_bytes));
  const auto reply = parse_schedule_reply(schedule_reply_bytes);
  ASSERT_TRUE(reply);
  EXPECT_EQ(reply->number, 513);
  EXPECT_EQ(reply->arrived, due);
  EXPECT_EQ(reply->replied, NodeTime(1234567890123999999));
}

TEST(ScheduledOutput, The_most_values_of_one_request_fill_the_pdu) {
  const std::vector<std::uint16_t> bits(max_scheduled_bits, 1);
  const std::vector<std::uint16_t> values(max_scheduled_registers, 1);
  EXPECT_EQ(bytes_of(ScheduleRequest::coils(at(milliseconds(0)), bits)).size(), max_pdu_size);
  EXPECT_EQ(bytes_of(ScheduleRequest::registers(at(milliseconds(0)), values)).size(), max_pdu_size);
  EXPECT_TRUE(parse_schedule_request(ScheduleRequest::coils(at(milliseconds(0)), bits).pdu()));
  EXPECT_TRUE(parse_schedule_request(ScheduleRequest::registers(at(milliseconds(0)), values).pdu()));
}

TEST(ScheduledOutput, A_request_that_is_cut_off_or_too_long_is_an_exception_03) {
  for (const Pdu& whole : {coils_bytes, registers_bytes, cancel_bytes, cancel_from_bytes}) {
    for (std::size_t size = 1; size < whole.size(); ++size)
      EXPECT_EQ(why_refused({whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)}),
                Exception::illegal_data_value);
    Pdu longer = whole;
    longer.push_back(0);
    EXPECT_EQ(why_refused(longer), Exception::illegal_data_value);
  }
}

TEST(ScheduledOutput, A_version_operation_table_or_quantity_that_is_not_allowed_is_an_exception_03) {
  EXPECT_EQ(why_refused(with(coils_bytes, 1, 2)), Exception::illegal_data_value) << "version";
  EXPECT_EQ(why_refused(with(coils_bytes, 2, 0)), Exception::illegal_data_value) << "operation";
  EXPECT_EQ(why_refused(with(coils_bytes, 2, 4)), Exception::illegal_data_value) << "operation";
  EXPECT_EQ(why_refused(with(coils_bytes, 19, 2)), Exception::illegal_data_value) << "discrete inputs";
  EXPECT_EQ(why_refused(with(registers_bytes, 19, 4)), Exception::illegal_data_value) << "input registers";
  EXPECT_EQ(why_refused(with(coils_bytes, 23, 0)), Exception::illegal_data_value) << "no coil";
  EXPECT_EQ(why_refused(with(coils_bytes, 23, 17)), Exception::illegal_data_value)
      << "bytes that do not match";
  EXPECT_EQ(why_refused(with(coils_bytes, 24, 3)), Exception::illegal_data_value) << "byte count";
}

TEST(ScheduledOutput,
     A_cancellation_of_many_with_a_version_table_or_count_that_is_not_allowed_is_an_exception_03) {
  EXPECT_EQ(why_refused(with(cancel_from_bytes, 1, 2)), Exception::illegal_data_value) << "version";
  for (const int table : {0, 2, 4})
    EXPECT_EQ(why_refused(with(cancel_from_bytes, 15, table)), Exception::illegal_data_value) << table;
  EXPECT_EQ(why_refused(with(cancel_from_bytes, 15, 1)), Exception{}) << "coils";
  EXPECT_EQ(why_refused(with(cancel_from_bytes, 19, 0)), Exception::illegal_data_value) << "no register";
}

TEST(ScheduledOutput, A_cancellation_of_many_past_the_last_address_is_an_exception_02) {
  const Pdu ends_at_the_last = with(with(cancel_from_bytes, 16, 0xFF), 17, 0xF6);
  EXPECT_EQ(why_refused(ends_at_the_last), Exception{});
  EXPECT_EQ(why_refused(with(ends_at_the_last, 19, 11)), Exception::illegal_data_address);
  EXPECT_EQ(why_refused(with(ends_at_the_last, 18, 0xFF)), Exception::illegal_data_address);
}

TEST(ScheduledOutput, A_duration_of_more_than_an_hour_is_an_exception_03) {
  Pdu pdu = coils_bytes;
  put_u32(&pdu[15], 3600000);
  EXPECT_EQ(why_refused(pdu), Exception{});
  put_u32(&pdu[15], 3600001);
  EXPECT_EQ(why_refused(pdu), Exception::illegal_data_value);
}

TEST(ScheduledOutput, Coils_past_the_last_address_are_an_exception_02) {
  EXPECT_EQ(why_refused(with(with(coils_bytes, 20, 0xFF), 21, 0xF7)), Exception::illegal_data_address);
  EXPECT_EQ(why_refused(with(with(coils_bytes, 20, 0xFF), 21, 0xF6)), Exception{});
}

TEST(ScheduledOutput, A_reply_of_another_length_or_version_is_none_and_an_exception_is_told) {
  EXPECT_FALSE(parse_schedule_reply(with(schedule_reply_bytes, 1, 2)));
  EXPECT_FALSE(parse_schedule_reply(Pdu(schedule_reply_bytes.begin(), schedule_reply_bytes.end() - 1)));
  const auto reply = parse_schedule_reply(Pdu{0xC2, 0x06});
  ASSERT_FALSE(reply);
  EXPECT_EQ(reply.error().exception, Exception::server_device_busy);
}

}  // namespace
}  // namespace coupler::modbus
