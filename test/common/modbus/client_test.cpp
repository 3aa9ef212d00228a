// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <vector>

#include "coupler/modbus/client.hpp"

namespace coupler::modbus {
namespace {

using testing::ElementsAre;

// The examples of MAP 6.1 and 6.3.
const ReadRequest nineteen_coils(Function::read_coils, Range::of(0x13, 19));
const ReadRequest three_registers(Function::read_holding_registers, Range::of(0x6B, 3));

TEST(ReadRequest, The_specifications_examples_are_built_byte_by_byte) {
  EXPECT_THAT(std::vector<int>(nineteen_coils.pdu().begin(), nineteen_coils.pdu().end()),
              ElementsAre(1, 0, 0x13, 0, 0x13));
  EXPECT_THAT(std::vector<int>(three_registers.pdu().begin(), three_registers.pdu().end()),
              ElementsAre(3, 0, 0x6B, 0, 3));
}

TEST(ReadRequest, The_specifications_replies_are_taken) {
  const std::uint8_t bits_reply[] = {1, 3, 0xCD, 0x6B, 0x05};
  std::vector<std::uint16_t> bits(19);
  ASSERT_TRUE(take_values(nineteen_coils, bits_reply, bits.data()));
  EXPECT_THAT(bits, ElementsAre(1, 0, 1, 1, 0, 0, 1, 1, 1, 1, 0, 1, 0, 1, 1, 0, 1, 0, 1));

  const std::uint8_t registers_reply[] = {3, 6, 0x02, 0x2B, 0, 0, 0, 0x64};
  std::vector<std::uint16_t> values(3);
  ASSERT_TRUE(take_values(three_registers, registers_reply, values.data()));
  EXPECT_THAT(values, ElementsAre(0x022B, 0, 0x64));
}

TEST(ReadRequest, A_reply_of_another_function_or_size_is_none) {
  const std::vector<std::vector<std::uint8_t>> replies{{},
                                                       {3},
                                                       {3, 6},
                                                       {3, 4, 0, 1, 0, 2},
                                                       {3, 4, 0, 1, 0, 2, 0, 3},
                                                       {3, 8, 0, 1, 0, 2, 0, 3, 0, 4},
                                                       {3, 6, 0, 1, 0, 2, 0, 3, 0},
                                                       {4, 6, 0, 1, 0, 2, 0, 3},
                                                       {0x84, 2}};
  std::vector<std::uint16_t> values(3);
  for (const auto& reply : replies) {
    const auto taken = take_values(three_registers, {reply.data(), reply.size()}, values.data());
    ASSERT_FALSE(taken);
    EXPECT_FALSE(taken.error().exception);
  }
}

TEST(ReadRequest, An_exception_brings_its_code_whatever_it_is) {
  const std::uint8_t reply[] = {0x81, 0x60};
  std::vector<std::uint16_t> bits(19);
  const auto taken = take_values(nineteen_coils, reply, bits.data());
  ASSERT_FALSE(taken);
  EXPECT_EQ(taken.error().exception, static_cast<Exception>(0x60));
}

}  // namespace

namespace {

std::vector<int> bytes(const WriteRequest& request) { return {request.pdu().begin(), request.pdu().end()}; }

// The examples of MAP 6.5, 6.6, 6.11, 6.12 and 6.16.
TEST(WriteRequest, The_specifications_examples_are_built_byte_by_byte) {
  const std::uint16_t coils[] = {1, 0, 1, 1, 0, 0, 1, 1, 1, 0};
  const std::uint16_t registers[] = {0x000A, 0x0102};
  EXPECT_THAT(bytes(WriteRequest::coil(0x00AC, true)), ElementsAre(5, 0, 0xAC, 0xFF, 0));
  EXPECT_THAT(bytes(WriteRequest::register_value(1, 3)), ElementsAre(6, 0, 1, 0, 3));
  EXPECT_THAT(bytes(WriteRequest::coils(0x13, coils)), ElementsAre(0x0F, 0, 0x13, 0, 0x0A, 2, 0xCD, 1));
  EXPECT_THAT(bytes(WriteRequest::registers(1, registers)), ElementsAre(0x10, 0, 1, 0, 2, 4, 0, 0x0A, 1, 2));
  EXPECT_THAT(bytes(WriteRequest::mask(4, 0xF2, 0x25)), ElementsAre(0x16, 0, 4, 0, 0xF2, 0, 0x25));
}

TEST(WriteRequest, The_reply_repeats_where_it_was_written_and_how_much) {
  const std::uint16_t registers[] = {7, 8};
  const auto request = WriteRequest::registers(1, registers);
  const std::uint8_t good[] = {0x10, 0, 1, 0, 2};
  const std::uint8_t less[] = {0x10, 0, 1, 0, 1};
  const std::uint8_t elsewhere[] = {0x10, 0, 2, 0, 2};
  EXPECT_TRUE(check_reply(request.pdu(), good));
  EXPECT_FALSE(check_reply(request.pdu(), less));
  EXPECT_FALSE(check_reply(request.pdu(), elsewhere));
}

TEST(WriteRequest, An_acknowledgement_of_another_value_is_told_with_that_value) {
  const std::uint8_t other_register[] = {6, 0, 1, 0, 9};
  EXPECT_EQ(check_reply(WriteRequest::register_value(1, 3).pdu(), other_register).error().other_value, 9);
  EXPECT_TRUE(check_reply(WriteRequest::register_value(1, 9).pdu(), other_register));
  const std::uint8_t off[] = {5, 0, 1, 0, 0};
  EXPECT_EQ(check_reply(WriteRequest::coil(1, true).pdu(), off).error().other_value, 0);
  EXPECT_TRUE(check_reply(WriteRequest::coil(1, false).pdu(), off));
}

TEST(WriteRequest, An_exception_brings_its_code_whatever_it_is) {
  const std::uint8_t reply[] = {0x85, 0x60};
  const auto checked = check_reply(WriteRequest::coil(1, true).pdu(), reply);
  ASSERT_FALSE(checked);
  EXPECT_EQ(checked.error().exception, static_cast<Exception>(0x60));
}

TEST(WriteRequest, The_exception_of_another_function_is_no_answer) {
  const std::uint8_t reply[] = {0x86, 2};
  const auto checked = check_reply(WriteRequest::coil(1, true).pdu(), reply);
  ASSERT_FALSE(checked);
  EXPECT_FALSE(checked.error().exception);
}

}  // namespace
}  // namespace coupler::modbus
