// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <limits>

#include "coupler/codec/text.hpp"
#include "coupler/codec/value.hpp"

namespace coupler::codec {
namespace {

using testing::HasSubstr;

Format format(Type type) {
  Format f;
  f.type = type;
  return f;
}

std::string refusal(const Value& value, const Format& f) {
  std::array<std::uint16_t, 8> registers{1, 2, 3, 4, 5, 6, 7, 8};
  const auto before = registers;
  const auto result = encode(value, f, registers.data());
  EXPECT_EQ(registers, before) << "a refused value changed the registers";
  return result ? "" : result.error();
}

TEST(Value, An_integer_out_of_its_type_is_refused_and_the_range_is_named) {
  EXPECT_EQ(refusal(std::int64_t{300}, format(Type::USINT)), "300 does not fit into USINT (0 to 255)");
  EXPECT_EQ(refusal(std::int64_t{-1}, format(Type::ULINT)),
            "-1 does not fit into ULINT (0 to 18446744073709551615)");
  EXPECT_EQ(refusal(std::int64_t{-129}, format(Type::SINT)), "-129 does not fit into SINT (-128 to 127)");
  EXPECT_EQ(refusal(std::uint64_t{1} << 63, format(Type::LINT)).substr(0, 38),
            "9223372036854775808 does not fit into ");
  EXPECT_EQ(refusal(std::uint64_t{65536}, format(Type::WORD)), "65536 does not fit into WORD (0 to 65535)");
}

TEST(Value, A_fraction_is_never_rounded_into_an_integer) {
  EXPECT_EQ(refusal(1.5, format(Type::INT)), "1.5 is not a whole number, as INT needs");
}

TEST(Value, A_whole_double_is_an_integer_where_it_fits) {
  const auto encoded = [](double value, Type type) {
    std::array<std::uint16_t, 4> registers{};
    Format f = format(type);
    f.order = Order::ABCD;
    EXPECT_TRUE(encode(value, f, registers.data())) << value;
    return registers;
  };
  using Registers = std::array<std::uint16_t, 4>;
  EXPECT_EQ(encoded(1e3, Type::UINT), Registers{1000});
  EXPECT_EQ(encoded(-2.0, Type::INT), Registers{0xFFFE});
  EXPECT_EQ(encoded(-0x1p63, Type::LINT), Registers{0x8000});
  EXPECT_EQ(encoded(0x1p63, Type::ULINT), Registers{0x8000});
  EXPECT_THAT(refusal(1e5, format(Type::UINT)), HasSubstr("does not fit into UINT (0 to 65535)"));
  EXPECT_THAT(refusal(-1.0, format(Type::USINT)), HasSubstr("does not fit into USINT (0 to 255)"));
  EXPECT_THAT(refusal(0x1p63, format(Type::LINT)), HasSubstr("does not fit into LINT"));
  EXPECT_THAT(refusal(0x1p64, format(Type::ULINT)), HasSubstr("does not fit into ULINT"));
  EXPECT_THAT(refusal(std::numeric_limits<double>::infinity(), format(Type::LINT)),
              HasSubstr("does not fit into LINT"));
  EXPECT_THAT(refusal(std::numeric_limits<double>::quiet_NaN(), format(Type::LINT)),
              HasSubstr("not a whole number"));
}

TEST(Value, A_double_beyond_float_is_refused_but_infinity_is_a_REAL) {
  EXPECT_THAT(refusal(1e300, format(Type::REAL)), HasSubstr("does not fit into REAL"));
  EXPECT_EQ(refusal(std::numeric_limits<double>::infinity(), format(Type::USINT)).empty(), false);
  std::array<std::uint16_t, 2> registers{};
  EXPECT_TRUE(encode(std::numeric_limits<double>::infinity(), format(Type::REAL), registers.data()));
  EXPECT_EQ(registers[0], 0x7F80);
}

TEST(Value, The_largest_REAL_goes_in_as_the_text_in_which_it_comes_out) {
  std::array<std::uint16_t, 2> registers{};
  Format real = format(Type::REAL);
  real.order = Order::ABCD;
  for (const double text : {3.4028235e38, -3.4028235e38}) {  // beyond FLT_MAX as a double
    EXPECT_TRUE(encode(text, real, registers.data())) << text;
    EXPECT_EQ(registers[0], text > 0 ? 0x7F7F : 0xFF7F);
    EXPECT_EQ(registers[1], 0xFFFF);
  }
  EXPECT_THAT(refusal(3.4028236e38, real), HasSubstr("does not fit into REAL"));
}

TEST(Value, A_kind_that_does_not_suit_the_type_is_refused) {
  EXPECT_EQ(refusal(std::int64_t{1}, format(Type::BOOL)), "1 is neither true nor false");
  EXPECT_EQ(refusal(true, format(Type::INT)), "'true' is not a number");
  EXPECT_EQ(refusal(std::string("7"), format(Type::INT)), "'7' is not a number");
}

TEST(Text, A_text_longer_than_its_length_is_refused) {
  Format f = format(Type::STRING);
  f.length = 3;
  EXPECT_EQ(refusal(std::string("ABCD"), f), "'ABCD' is longer than 3 bytes");
  EXPECT_EQ(refusal(std::string("aé€"), f), "'aé€' is longer than 3 bytes");
}

TEST(Text, A_character_that_the_encoding_lacks_is_refused) {
  Format f = format(Type::STRING);
  f.length = 8;
  f.encoding = Encoding::latin1;
  EXPECT_EQ(refusal(std::string("5 €"), f), "'5 €' cannot be written in latin-1");
  f.encoding = Encoding::ascii;
  EXPECT_EQ(refusal(std::string("5 °"), f), "'5 °' cannot be written in ascii");
  f.encoding = Encoding::utf8;
  EXPECT_THAT(refusal(std::string("\xC3("), f), HasSubstr("cannot be written in utf-8"));
  EXPECT_THAT(refusal(std::string("\xED\xA0\x80"), f), HasSubstr("cannot be written"));
}

TEST(Text, A_text_with_a_NUL_character_is_refused) {
  Format f = format(Type::STRING);
  f.length = 8;
  EXPECT_THAT(refusal(std::string("a\0z", 3), f), HasSubstr("NUL"));
}

TEST(Text, A_value_ends_at_the_first_NUL) {
  Format f = format(Type::STRING);
  f.length = 6;
  f.order = Order::ABCD;
  const std::array<std::uint16_t, 3> registers{0x4142, 0x0043, 0x4445};
  EXPECT_EQ(std::get<std::string>(decode(registers.data(), f)), "AB");
}

TEST(Text, A_byte_that_ascii_lacks_reads_as_a_question_mark) {
  Format f = format(Type::STRING);
  f.length = 2;
  f.order = Order::ABCD;
  f.encoding = Encoding::ascii;
  const std::uint16_t word = 0x41E9;
  EXPECT_EQ(std::get<std::string>(decode(&word, f)), "A?");
}

TEST(Format, Halves_and_bits_mask_exactly_their_part) {
  Format f = format(Type::SINT);
  EXPECT_EQ(mask(f), 0xFF00);
  f.half = Half::low;
  EXPECT_EQ(mask(f), 0x00FF);
  f.order = Order::BADC;
  EXPECT_EQ(mask(f), 0xFF00);
  f = format(Type::BOOL);
  f.bit = 3;
  EXPECT_EQ(mask(f), 0x0008);
  f.order = Order::BADC;
  EXPECT_EQ(mask(f), 0x0800);
  EXPECT_EQ(mask(format(Type::UINT)), 0xFFFF);
}

TEST(Text, Bytes_that_are_no_utf_8_are_escaped) {
  Format f = format(Type::STRING);
  f.length = 6;
  f.order = Order::ABCD;
  const std::uint16_t registers[] = {0x67FC, 0xC3A9, 0xE282};  // "g", 0xFC, "é", and a character that is cut
  EXPECT_EQ(std::get<std::string>(decode(registers, f)), "g\\xfcé\\xe2\\x82");
  EXPECT_EQ(first_unknown_byte(registers, f), 0xFC);
  f.encoding = Encoding::latin1;
  EXPECT_EQ(std::get<std::string>(decode(registers, f)), "gü\u00C3©â\u0082");
  EXPECT_EQ(first_unknown_byte(registers, f), std::nullopt);
}

TEST(Text, A_byte_that_ascii_does_not_have_is_found_before_the_end_of_the_text_only) {
  Format f = format(Type::STRING);
  f.length = 4;
  f.order = Order::ABCD;
  f.encoding = Encoding::ascii;
  const std::uint16_t text[] = {0x4142, 0x00FF};
  EXPECT_EQ(first_unknown_byte(text, f), std::nullopt);
  const std::uint16_t odd[] = {0x41B0, 0x0000};
  EXPECT_EQ(first_unknown_byte(odd, f), 0xB0);
}

TEST(Format, Registers_follow_from_the_type) {
  Format f = format(Type::STRING);
  f.length = 5;
  EXPECT_EQ(registers(f), 3);
  EXPECT_EQ(registers(format(Type::CHAR)), 1);
  EXPECT_EQ(registers(format(Type::REAL)), 2);
  EXPECT_EQ(registers(format(Type::LWORD)), 4);
}

}  // namespace

namespace {

using Float = std::numeric_limits<float>;
using Double = std::numeric_limits<double>;

TEST(Decimal, Has_the_fewest_digits_that_tell_the_number_of_its_type) {
  EXPECT_EQ(decimal(0.1), "0.1");
  EXPECT_EQ(decimal(0.1F), "0.1");
  EXPECT_EQ(decimal(0.1 + 0.2), "0.30000000000000004");
  EXPECT_EQ(decimal(-1234.5625), "-1234.5625");
  EXPECT_EQ(decimal(Double::max()), "1.7976931348623157e308");
  EXPECT_EQ(decimal(Double::denorm_min()), "5.0e-324");
  EXPECT_EQ(decimal(Float::max()), "3.4028235e38");
}

TEST(Decimal, Always_looks_like_a_float) {
  EXPECT_EQ(decimal(0.0), "0.0");
  EXPECT_EQ(decimal(-0.0), "-0.0");
  EXPECT_EQ(decimal(20.0), "20.0");
  EXPECT_EQ(decimal(16777216.0F), "16777216.0");
}

TEST(Decimal, Has_an_exponent_where_zeros_would_be_many) {
  EXPECT_EQ(decimal(1e15), "1000000000000000.0");
  EXPECT_EQ(decimal(1e16), "1.0e16");
  EXPECT_EQ(decimal(0.00001), "0.00001");
  EXPECT_EQ(decimal(0.000001), "1.0e-6");
}

}  // namespace
}  // namespace coupler::codec
