// SPDX-License-Identifier: Apache-2.0
#include "coupler/map/printable.hpp"

#include <gtest/gtest.h>

namespace coupler {
namespace {

TEST(Printable, Letters_and_signs_of_every_language_stay) {
  EXPECT_EQ(printable("21.5 °C, Öl, 温度, 😀, a\\b"), "21.5 °C, Öl, 温度, 😀, a\\b");
  EXPECT_EQ(printable(""), "");
}

TEST(Printable, Control_characters_of_every_kind_are_escaped) {
  EXPECT_EQ(printable("\x1B[2J\r\n\t\x7F"), "\\x1b[2J\\x0d\\x0a\\x09\\x7f");
  EXPECT_EQ(printable(std::string_view("a\0b", 3)), "a\\x00b");
  EXPECT_EQ(printable("\u0080\u009B31m\u009F\u00A0"), "\\x80\\x9b31m\\x9f\u00A0");
}

TEST(Printable, What_turns_the_direction_of_writing_is_escaped) {
  EXPECT_EQ(printable("a\u202Eb\u202A\u2066\u2069\u200E\u200F"),
            "a\\u202eb\\u202a\\u2066\\u2069\\u200e\\u200f");
  EXPECT_EQ(printable("\u2029\u202F\u2065\u206A\u200D"), "\u2029\u202F\u2065\u206A\u200D")
      << "their neighbours";
}

TEST(Printable, Bytes_that_are_no_UTF_8_are_escaped_one_by_one) {
  EXPECT_EQ(printable("\x9B\xFF"), "\\x9b\\xff");
  EXPECT_EQ(printable("\xC2"), "\\xc2") << "cut off";
  EXPECT_EQ(printable("\xC0\x9B"), "\\xc0\\x9b") << "longer than needed";
  EXPECT_EQ(printable("\xE0\x82\x9B"), "\\xe0\\x82\\x9b");
  EXPECT_EQ(printable("\xED\xA0\x80"), "\\xed\\xa0\\x80") << "half of a surrogate pair";
  EXPECT_EQ(printable("\xF4\x90\x80\x80"), "\\xf4\\x90\\x80\\x80") << "beyond the last character";
}

TEST(Printable, Lines_and_tabs_stay_where_they_are_wanted) {
  EXPECT_EQ(printable_lines("one\n\ttwo\r\n\x1B"), "one\n\ttwo\\x0d\n\\x1b");
}

}  // namespace
}  // namespace coupler
