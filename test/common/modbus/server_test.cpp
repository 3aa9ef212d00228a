// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <optional>
#include <vector>

#include "coupler/modbus/limits.hpp"
#include "coupler/modbus/server.hpp"

namespace coupler::modbus {
namespace {

using testing::ElementsAre;
using Pdu = std::vector<std::uint8_t>;

Pdu bytes_of(Bytes bytes) { return {bytes.begin(), bytes.end()}; }

constexpr auto bad_function = Exception::illegal_function;
constexpr auto bad_address = Exception::illegal_data_address;
constexpr auto bad_value = Exception::illegal_data_value;

/// A PDU of a function code and 16-bit fields.
Pdu pdu(int function, std::initializer_list<int> fields, const Pdu& rest = {}) {
  Pdu bytes{static_cast<std::uint8_t>(function)};
  for (const int field : fields) {
    bytes.push_back(static_cast<std::uint8_t>(field >> 8));
    bytes.push_back(static_cast<std::uint8_t>(field));
  }
  bytes.insert(bytes.end(), rest.begin(), rest.end());
  return bytes;
}

/// A byte count and as many bytes.
Pdu counted(std::size_t bytes) {
  Pdu data(1 + bytes, 0x5A);
  data[0] = static_cast<std::uint8_t>(bytes);
  return data;
}

std::optional<Exception> refusal(const Pdu& bytes) {
  const auto parsed = parse_request(bytes);
  return parsed ? std::nullopt : std::optional(parsed.error());
}

TEST(Request, A_read_names_its_table_and_range) {
  for (const int function : {1, 2, 3, 4}) {
    const auto request = parse_request(pdu(function, {0x0123, 7}));
    ASSERT_TRUE(request.has_value());
    const auto& read = std::get<Read>(*request);
    EXPECT_EQ(static_cast<int>(read.function), function);
    EXPECT_EQ(read.range, Range::of(0x0123, 7));
  }
}

TEST(Request, Query_data_is_any_number_of_words) {
  for (const Pdu& words : {Pdu{0xA5, 0x37}, Pdu(2, 0), Pdu(250, 1)}) {
    const auto request = parse_request(pdu(8, {0}, words));
    ASSERT_TRUE(request.has_value());
    EXPECT_TRUE(std::holds_alternative<Echo>(*request));
  }
  for (const Pdu& data : {Pdu{}, Pdu{1}, Pdu{1, 2, 3}}) EXPECT_EQ(refusal(pdu(8, {0}, data)), bad_value);
  EXPECT_EQ(refusal({8}), bad_value);
  EXPECT_EQ(refusal({8, 0}), bad_value);
}

TEST(Request, Other_diagnostics_are_no_function) {
  for (int sub = 1; sub < 0x10000; sub += 0x101) EXPECT_EQ(refusal(pdu(8, {sub, 0})), bad_function) << sub;
  EXPECT_EQ(refusal(pdu(8, {1})), bad_function);
}

TEST(Request, An_identification_is_read_by_43_14) {
  const auto request = parse_request(Pdu{43, 14, 1, 0});
  ASSERT_TRUE(request.has_value());
  EXPECT_TRUE(std::holds_alternative<ReadDeviceIdentification>(*request));
  EXPECT_EQ(refusal({43, 13, 0, 0}), bad_function);
}

TEST(Request, A_write_carries_its_values) {
  const auto coil = parse_request(pdu(5, {9, 0xFF00}));
  ASSERT_TRUE(coil.has_value());
  EXPECT_EQ(std::get<WriteBits>(*coil).range, Range::of(9, 1));
  EXPECT_THAT(bytes_of(std::get<WriteBits>(*coil).packed), ElementsAre(1));
  EXPECT_THAT(bytes_of(std::get<WriteBits>(*parse_request(pdu(5, {9, 0}))).packed), ElementsAre(0));

  const Pdu single_bytes = pdu(6, {9, 0xABCD});
  const auto single = parse_request(single_bytes);
  ASSERT_TRUE(single.has_value());
  EXPECT_THAT(bytes_of(std::get<WriteRegisters>(*single).values), ElementsAre(0xAB, 0xCD));

  const Pdu bytes_of_coils = pdu(15, {19, 10}, {2, 0xCD, 0x01});
  const auto coils = parse_request(bytes_of_coils);
  ASSERT_TRUE(coils.has_value());
  EXPECT_EQ(std::get<WriteBits>(*coils).range, Range::of(19, 10));
  EXPECT_THAT(bytes_of(std::get<WriteBits>(*coils).packed), ElementsAre(0xCD, 0x01));

  const Pdu bytes_of_registers = pdu(16, {1, 2}, {4, 0, 10, 1, 2});
  const auto registers = parse_request(bytes_of_registers);
  ASSERT_TRUE(registers.has_value());
  EXPECT_EQ(std::get<WriteRegisters>(*registers).range, Range::of(1, 2));
  EXPECT_THAT(bytes_of(std::get<WriteRegisters>(*registers).values), ElementsAre(0, 10, 1, 2));
}

TEST(Request, A_mask_write_carries_both_masks) {
  const auto request = parse_request(pdu(22, {4, 0x00F2, 0x0025}));
  ASSERT_TRUE(request.has_value());
  EXPECT_EQ(std::get<MaskWrite>(*request).range, Range::of(4, 1));
  EXPECT_EQ(std::get<MaskWrite>(*request).and_mask, 0x00F2);
  EXPECT_EQ(std::get<MaskWrite>(*request).or_mask, 0x0025);
}

TEST(Request, A_read_write_carries_both_ranges) {
  const Pdu bytes = pdu(23, {3, 6, 14, 2}, {4, 0, 255, 0, 254});
  const auto request = parse_request(bytes);
  ASSERT_TRUE(request.has_value());
  EXPECT_EQ(std::get<ReadWriteRegisters>(*request).read, Range::of(3, 6));
  EXPECT_EQ(std::get<ReadWriteRegisters>(*request).write.range, Range::of(14, 2));
  EXPECT_THAT(bytes_of(std::get<ReadWriteRegisters>(*request).write.values), ElementsAre(0, 255, 0, 254));
}

TEST(Request, A_function_that_is_not_spoken_here_is_illegal_whatever_follows) {
  for (const int function : {0, 7, 9, 17, 21, 24, 42, 90, 127, 128, 129, 131, 255}) {
    EXPECT_EQ(refusal(pdu(function, {})), bad_function) << function;
    EXPECT_EQ(refusal(pdu(function, {0, 1})), bad_function) << function;
  }
}

TEST(Request, A_bare_function_code_is_an_illegal_value) {
  for (const int function : {1, 2, 3, 4, 5, 6, 8, 15, 16, 20, 22, 23, 43})
    EXPECT_EQ(refusal(pdu(function, {})), bad_value) << function;
}

TEST(Request, A_pdu_longer_or_shorter_than_its_request_is_an_illegal_value) {
  const std::vector<Pdu> good{pdu(1, {0, 1}),
                              pdu(2, {0, 1}),
                              pdu(3, {0, 1}),
                              pdu(4, {0, 1}),
                              pdu(5, {0, 0}),
                              pdu(6, {0, 0}),
                              pdu(15, {0, 9}, counted(2)),
                              pdu(16, {0, 2}, counted(4)),
                              pdu(22, {0, 0, 0}),
                              pdu(23, {0, 1, 0, 1}, counted(2))};
  for (const Pdu& bytes : good) {
    ASSERT_EQ(refusal(bytes), std::nullopt) << int{bytes[0]};
    Pdu longer = bytes;
    longer.push_back(0);
    EXPECT_EQ(refusal(longer), bad_value) << int{bytes[0]};
    for (std::size_t size = 1; size < bytes.size(); ++size)
      EXPECT_EQ(refusal(Pdu(bytes.begin(), bytes.begin() + static_cast<long>(size))), bad_value)
          << int{bytes[0]};
  }
}

TEST(Request, A_quantity_of_0_or_above_the_limit_is_an_illegal_value) {
  struct Limit {
    int function;
    int limit;
  };
  for (const auto& [function, limit] : {Limit{1, 2000}, Limit{2, 2000}, Limit{3, 125}, Limit{4, 125}}) {
    EXPECT_EQ(refusal(pdu(function, {0, limit})), std::nullopt);
    for (const int quantity : {0, limit + 1, 0xFFFF})
      EXPECT_EQ(refusal(pdu(function, {0, quantity})), bad_value);
  }
  EXPECT_EQ(refusal(pdu(15, {0, 1968}, counted(246))), std::nullopt);
  EXPECT_EQ(refusal(pdu(15, {0, 1969}, counted(247))), bad_value);
  EXPECT_EQ(refusal(pdu(15, {0, 0}, counted(0))), bad_value);
  EXPECT_EQ(refusal(pdu(16, {0, 123}, counted(246))), std::nullopt);
  EXPECT_EQ(refusal(pdu(16, {0, 124}, counted(248))), bad_value);
  EXPECT_EQ(refusal(pdu(16, {0, 0}, counted(0))), bad_value);
  EXPECT_EQ(refusal(pdu(23, {0, 125, 0, 121}, counted(242))), std::nullopt);
  EXPECT_EQ(refusal(pdu(23, {0, 126, 0, 1}, counted(2))), bad_value);
  EXPECT_EQ(refusal(pdu(23, {0, 1, 0, 122}, counted(244))), bad_value);
}

TEST(Request, A_byte_count_that_does_not_match_the_quantity_is_an_illegal_value) {
  EXPECT_EQ(refusal(pdu(15, {0, 9}, counted(1))), bad_value);
  EXPECT_EQ(refusal(pdu(15, {0, 9}, counted(3))), bad_value);
  EXPECT_EQ(refusal(pdu(16, {0, 2}, counted(3))), bad_value);
  EXPECT_EQ(refusal(pdu(16, {0, 2}, counted(6))), bad_value);
  EXPECT_EQ(refusal(pdu(23, {0, 1, 0, 2}, counted(2))), bad_value);
}

TEST(Request, A_coil_is_written_with_0x0000_or_0xFF00_only) {
  for (const int value : {1, 0x00FF, 0x0100, 0xFE00, 0xFF01, 0xFFFF})
    EXPECT_EQ(refusal(pdu(5, {0, value})), bad_value) << value;
}

TEST(Request, A_range_that_runs_past_65535_is_an_illegal_address) {
  for (const int function : {1, 2, 3, 4}) {
    EXPECT_EQ(refusal(pdu(function, {0xFFFF, 1})), std::nullopt);
    EXPECT_EQ(refusal(pdu(function, {0xFFFF, 2})), bad_address);
    EXPECT_EQ(refusal(pdu(function, {0xFFC0, 100})), bad_address);
  }
  EXPECT_EQ(refusal(pdu(15, {0xFFFF, 2}, counted(1))), bad_address);
  EXPECT_EQ(refusal(pdu(16, {0xFFFF, 2}, counted(4))), bad_address);
  EXPECT_EQ(refusal(pdu(23, {0xFFFF, 2, 0, 1}, counted(2))), bad_address);
  EXPECT_EQ(refusal(pdu(23, {0, 1, 0xFFFF, 2}, counted(4))), bad_address);
}

}  // namespace

namespace {

using testing::ElementsAreArray;

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
