// SPDX-License-Identifier: Apache-2.0
#include "coupler/modbus/read_request.hpp"

#include <gmock/gmock.h>

#include <vector>

namespace coupler::modbus {
namespace {

using testing::ElementsAre;

// The examples of MAP 6.1 and 6.3.
const ReadRequest coils(Function::read_coils, Range::of(0x13, 19));
const ReadRequest three_registers(Function::read_holding_registers, Range::of(0x6B, 3));

TEST(ReadRequest, The_specifications_examples_are_built_byte_by_byte) {
  EXPECT_THAT(std::vector<int>(coils.pdu().begin(), coils.pdu().end()), ElementsAre(1, 0, 0x13, 0, 0x13));
  EXPECT_THAT(std::vector<int>(three_registers.pdu().begin(), three_registers.pdu().end()),
              ElementsAre(3, 0, 0x6B, 0, 3));
}

TEST(ReadRequest, The_specifications_replies_are_taken) {
  const std::uint8_t bits_reply[] = {1, 3, 0xCD, 0x6B, 0x05};
  std::vector<std::uint8_t> bits(19);
  ASSERT_TRUE(take_bits(coils, bits_reply, bits.data()));
  EXPECT_THAT(bits, ElementsAre(1, 0, 1, 1, 0, 0, 1, 1, 1, 1, 0, 1, 0, 1, 1, 0, 1, 0, 1));

  const std::uint8_t registers_reply[] = {3, 6, 0x02, 0x2B, 0, 0, 0, 0x64};
  std::vector<std::uint16_t> values(3);
  ASSERT_TRUE(take_registers(three_registers, registers_reply, values.data()));
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
    const auto taken = take_registers(three_registers, {reply.data(), reply.size()}, values.data());
    ASSERT_FALSE(taken);
    EXPECT_FALSE(taken.error().exception);
  }
}

TEST(ReadRequest, An_exception_brings_its_code_whatever_it_is) {
  const std::uint8_t reply[] = {0x81, 0x60};
  std::vector<std::uint8_t> bits(19);
  const auto taken = take_bits(coils, reply, bits.data());
  ASSERT_FALSE(taken);
  EXPECT_EQ(taken.error().exception, static_cast<Exception>(0x60));
}

}  // namespace
}  // namespace coupler::modbus
