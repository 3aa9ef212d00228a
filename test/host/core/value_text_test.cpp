// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/core/value_text.hpp"

#include <gmock/gmock.h>

#include <vector>

namespace coupler::host {
namespace {

using testing::HasSubstr;

Point point_of(codec::Type type, std::uint16_t count = 1, Table table = Table::holding_registers) {
  Point point;
  point.table = table;
  point.format.type = type;
  point.count = count;
  return point;
}

std::vector<std::uint16_t> parsed(std::string_view text, const Point& point) {
  std::vector<std::uint16_t> registers(range(point).count(), 0xAAAA);
  const auto done = parse_value(text, point, registers.data());
  EXPECT_TRUE(done) << text << ": " << (done ? "" : done.error());
  return registers;
}

std::string error_of(std::string_view text, const Point& point) {
  std::vector<std::uint16_t> registers(range(point).count());
  const auto done = parse_value(text, point, registers.data());
  return done ? "" : done.error();
}

using Registers = std::vector<std::uint16_t>;

TEST(ValueText, A_coil_is_true_or_false_in_the_usual_words) {
  const Point coil = point_of(codec::Type::BOOL, 1, Table::coils);
  for (const char* yes : {"true", "True", "on", "1", " true "})
    EXPECT_EQ(parsed(yes, coil), Registers{1}) << yes;
  for (const char* no : {"false", "off", "0"}) EXPECT_EQ(parsed(no, coil), Registers{0}) << no;
  for (const char* other : {"2", "TRUE", "yes", ""})
    EXPECT_THAT(error_of(other, coil),
                HasSubstr("neither true nor false; send true or false (or on, off, 1, 0)"));
}

TEST(ValueText, A_named_value_is_written_and_read_by_its_name) {
  constexpr NamedValue names[] = {{-1, "fault"}, {0, "off"}, {2, "auto"}};
  Point mode = point_of(codec::Type::INT);
  mode.values = names;
  EXPECT_EQ(parsed(" auto ", mode), Registers{2});
  EXPECT_EQ(parsed("2", mode), Registers{2});
  EXPECT_EQ(parsed("fault", mode), Registers{0xFFFF});
  EXPECT_THAT(error_of("Auto", mode),
              HasSubstr("not one of its values; send fault (-1), off (0) or auto (2)"));
  const std::uint16_t named = 2;
  const std::uint16_t unnamed = 3;
  EXPECT_EQ(format_value(&named, mode), "auto");
  EXPECT_EQ(format_value(&unnamed, mode), "3");
}

TEST(ValueText, What_is_refused_is_told_with_what_may_be_sent) {
  Point level = point_of(codec::Type::INT);
  EXPECT_EQ(error_of("full", level), "'full' is not a number; send one, as 4711, 0x2F or -1.5");
  level.bounds.min = 0;
  level.bounds.max = 10;
  EXPECT_EQ(error_of("full", level), "'full' is not a number; send 0 to 10");
  Point label = point_of(codec::Type::STRING);
  label.format.length = 2;
  EXPECT_THAT(error_of("left", label), HasSubstr("give at most 2 bytes"));
  label.format.encoding = codec::Encoding::ascii;
  EXPECT_THAT(error_of("°", label), HasSubstr("leave out what it does not have"));
}

TEST(ValueText, A_bit_of_a_register_leaves_the_others_zero) {
  Point bit = point_of(codec::Type::BOOL);
  bit.format.bit = 3;
  EXPECT_EQ(parsed("true", bit), Registers{8});
  EXPECT_EQ(parsed("false", bit), Registers{0});
}

TEST(ValueText, Numbers_are_decimal_or_hexadecimal) {
  EXPECT_EQ(parsed("-2", point_of(codec::Type::INT)), Registers{0xFFFE});
  EXPECT_EQ(parsed("0x2f", point_of(codec::Type::WORD)), Registers{0x2F});
  EXPECT_EQ(parsed("18446744073709551615", point_of(codec::Type::ULINT)), Registers(4, 0xFFFF));
  EXPECT_EQ(parsed("1", point_of(codec::Type::REAL)), (Registers{0x3F80, 0}));
  EXPECT_EQ(parsed("1.0", point_of(codec::Type::REAL)), (Registers{0x3F80, 0}));
  EXPECT_EQ(parsed("1e3", point_of(codec::Type::UINT)), Registers{1000});
}

TEST(ValueText, What_does_not_fit_is_refused_with_what_would) {
  EXPECT_THAT(error_of("70000", point_of(codec::Type::UINT)), HasSubstr("0 to 65535"));
  EXPECT_THAT(error_of("1.5", point_of(codec::Type::INT)), HasSubstr("not a whole number"));
  EXPECT_THAT(error_of("fast", point_of(codec::Type::INT)), HasSubstr("'fast' is not a number"));
  EXPECT_THAT(error_of("", point_of(codec::Type::INT)), HasSubstr("not a number"));
}

TEST(ValueText, An_array_has_each_of_its_elements) {
  EXPECT_EQ(parsed("[1, 2,3]", point_of(codec::Type::UINT, 3)), (Registers{1, 2, 3}));
  EXPECT_EQ(parsed("1,0", point_of(codec::Type::BOOL, 2, Table::coils)), (Registers{1, 0}));
  EXPECT_THAT(error_of("[1, 2]", point_of(codec::Type::UINT, 3)), HasSubstr("2 elements; give 3"));
}

TEST(ValueText, A_scaled_point_speaks_in_published_units) {
  Point point = point_of(codec::Type::INT);
  point.scale = {0.1, -40};
  point.units = "°C";
  EXPECT_EQ(parsed("21.5", point), Registers{615});
  EXPECT_EQ(parsed("-40", point), Registers{0});
  const Registers raw{615};
  EXPECT_EQ(format_value(raw.data(), point), "21.5");
  EXPECT_THAT(error_of("5000", point), HasSubstr("5000 °C is out of range; send -3316.8 to 3236.7 °C"));
  Point limited = point;
  limited.bounds = {0, 100};
  EXPECT_THAT(error_of("5000", limited), HasSubstr("send 0 to 100 °C")) << "not what the type could hold";
  EXPECT_THAT(error_of("nan", limited), HasSubstr("send 0 to 100 °C"));
  EXPECT_THAT(error_of("nan", point), HasSubstr("not a number"));
}

TEST(ValueText, A_scaled_value_has_no_digits_that_tell_nothing) {
  Point point = point_of(codec::Type::UINT);
  point.scale.gain = 0.1;
  for (std::uint32_t raw = 0; raw <= 0xFFFF; ++raw) {
    const Registers registers{static_cast<std::uint16_t>(raw)};
    const std::string text = format_value(registers.data(), point);
    ASSERT_LE(text.size(), 6U) << text;
    ASSERT_EQ(parsed(text, point), registers);
  }
  EXPECT_EQ(format_value(Registers{217}.data(), point), "21.7");
  Point wide = point_of(codec::Type::ULINT);
  wide.scale.gain = 2;
  const Registers raw{0x000F, 0xFFFF, 0xFFFF, 0xFFFF};  // more digits than 15
  EXPECT_EQ(parsed(format_value(raw.data(), wide), wide), raw);
  Point real = point_of(codec::Type::REAL);
  real.scale.gain = 2;
  EXPECT_EQ(format_value(Registers{0x7FC0, 0}.data(), real), "nan");
}

TEST(ValueText, A_text_is_taken_as_it_stands) {
  Point text = point_of(codec::Type::STRING);
  text.format.length = 4;
  EXPECT_EQ(parsed(" a,b", text), (Registers{0x2061, 0x2C62}));
  EXPECT_THAT(error_of("abcde", text), HasSubstr("give at most 4 bytes"));
}

TEST(ValueText, Bit_strings_are_shown_in_hexadecimal_with_all_digits) {
  EXPECT_EQ(format_value(Registers{0x00AF}.data(), point_of(codec::Type::WORD)), "0x00AF");
  EXPECT_EQ(format_value(Registers{1, 0x2345}.data(), point_of(codec::Type::DWORD)), "0x00012345");
  EXPECT_EQ(format_value(Registers{0, 0, 0, 9}.data(), point_of(codec::Type::LWORD)), "0x0000000000000009");
  EXPECT_EQ(format_value(Registers{7, 0xFFFF}.data(), point_of(codec::Type::WORD, 2)), "[0x0007, 0xFFFF]");
  EXPECT_EQ(format_value(Registers{0x0700}.data(), point_of(codec::Type::BYTE)), "0x07");
}

TEST(ValueText, What_is_shown_can_be_given_back) {
  for (const Point& point : {point_of(codec::Type::INT, 3), point_of(codec::Type::WORD),
                             point_of(codec::Type::LREAL), point_of(codec::Type::ULINT, 2)}) {
    Registers registers(range(point).count());
    std::uint16_t value = 0x8123;
    for (auto& r : registers) r = value = static_cast<std::uint16_t>(value * 7 + 1);
    EXPECT_EQ(parsed(format_value(registers.data(), point), point), registers);
  }
  const Registers bits{1, 0};
  EXPECT_EQ(format_value(bits.data(), point_of(codec::Type::BOOL, 2, Table::coils)), "[true, false]");
}

}  // namespace
}  // namespace coupler::host
