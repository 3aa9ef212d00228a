// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "coupler/modbus/limits.hpp"
#include "coupler/modbus/reply.hpp"

namespace coupler::modbus {
namespace {

using testing::ElementsAre;
using testing::ElementsAreArray;
using Pdu = std::vector<std::uint8_t>;

class Reply : public testing::Test {
 protected:
  Pdu built(std::size_t size) const {
    return Pdu(buffer_.begin(), buffer_.begin() + static_cast<long>(size));
  }
  std::array<std::uint8_t, max_pdu_size> buffer_{};
};

TEST_F(Reply, An_exception_sets_the_top_bit_of_the_function_code) {
  EXPECT_THAT(built(reply_exception(3, Exception::illegal_data_address, buffer_)), ElementsAre(0x83, 2));
  EXPECT_THAT(built(reply_exception(0, Exception::illegal_function, buffer_)), ElementsAre(0x80, 1));
  EXPECT_THAT(built(reply_exception(0xFF, Exception::illegal_function, buffer_)), ElementsAre(0xFF, 1));
}

TEST_F(Reply, The_first_bit_is_the_lowest_of_the_first_byte_and_spare_bits_are_0) {
  buffer_.fill(0xEE);
  const std::array<std::uint16_t, 10> bits{1, 0, 1, 1, 0, 0, 0, 0, 0, 1};
  EXPECT_THAT(built(reply_bits(Function::read_coils, bits, buffer_)), ElementsAre(1, 2, 0x0D, 0x02));
}

TEST_F(Reply, Registers_are_big_endian) {
  const std::array<std::uint16_t, 2> registers{0x1234, 0xFEDC};
  EXPECT_THAT(built(reply_registers(Function::read_input_registers, registers, buffer_)),
              ElementsAre(4, 4, 0x12, 0x34, 0xFE, 0xDC));
}

TEST_F(Reply, The_longest_replies_fit_the_pdu) {
  EXPECT_EQ(reply_bits(Function::read_coils, std::vector<std::uint16_t>(max_read_bits, 1), buffer_), 252U);
  EXPECT_EQ(reply_registers(Function::read_holding_registers, std::vector<std::uint16_t>(max_read_registers),
                            buffer_),
            252U);
}

TEST_F(Reply, A_written_value_is_acknowledged_by_repeating_it_or_its_place) {
  for (const Pdu& request :
       {Pdu{5, 0, 1, 0xFF, 0}, Pdu{6, 0, 1, 0x12, 0x34}, Pdu{22, 0, 1, 0, 0xF2, 0, 0x25}})
    EXPECT_THAT(built(reply_written(request, buffer_)), ElementsAreArray(request));
  EXPECT_THAT(built(reply_written(Pdu{15, 0, 19, 0, 10, 2, 0xCD, 1}, buffer_)),
              ElementsAre(15, 0, 19, 0, 10));
  EXPECT_THAT(built(reply_written(Pdu{16, 0, 1, 0, 1, 2, 0, 10}, buffer_)), ElementsAre(16, 0, 1, 0, 1));
}

}  // namespace
}  // namespace coupler::modbus
