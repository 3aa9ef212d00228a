// SPDX-License-Identifier: Apache-2.0
#include "coupler/generate/code.hpp"

#include <gtest/gtest.h>

namespace coupler::generate {
namespace {

TEST(Literal, Plain_text_is_quoted) { EXPECT_EQ(literal("plain text"), R"("plain text")"); }

TEST(Literal, Quotes_backslashes_and_controls_are_escaped) {
  EXPECT_EQ(literal("\"\\\t\r\n\x01\x7F"), R"("\"\\\t\r\n\001\177")");
}

TEST(Literal, A_digit_after_an_escaped_byte_stays_a_digit) {
  EXPECT_EQ(literal("\x01"
                    "7"),
            R"("\0017")");
}

TEST(Literal, A_NUL_inside_survives) { EXPECT_EQ(literal(std::string_view("a\0b", 3)), R"("a\000b")"); }

TEST(Literal, No_trigraph_can_arise) {
  EXPECT_EQ(literal("?"
                    "?"
                    "?/"),
            R"("?\?\?/")");
}

TEST(Literal, Lines_of_text_are_lines_of_source) {
  EXPECT_EQ(literal_lines("one\n\ntwo", "  "), "  \"one\\n\"\n  \"\\n\"\n  \"two\"");
}

TEST(Literal, A_final_newline_adds_no_line) { EXPECT_EQ(literal_lines("one\n", ""), R"("one\n")"); }

TEST(Literal, No_text_is_an_empty_literal) { EXPECT_EQ(literal_lines("", ""), "\"\""); }

TEST(Comment, Is_one_line) { EXPECT_EQ(comment("one\ntwo\r\x7F\u0085"), "one two   "); }

TEST(Comment, Keeps_letters_of_every_language) { EXPECT_EQ(comment("Öl – 20 °C"), "Öl – 20 °C"); }

TEST(Comment, Drops_what_turns_the_writing_direction) {
  EXPECT_EQ(comment("a\u202Eb\u2066c\u200Fd\xE2"), "abcd\xE2");
}

TEST(Identifier, Is_letters_digits_and_underscores_with_a_letter_first) {
  EXPECT_TRUE(is_identifier("cell_2"));
  for (const char* bad : {"", "2cell", "_cell", "cell-2", "cell/2", "cell 2", "zölle"})
    EXPECT_FALSE(is_identifier(bad));
}

TEST(Identifier, Is_no_word_of_the_language) {
  for (const char* bad : {"alignas", "int", "switch", "std", "xor_eq"}) EXPECT_FALSE(is_identifier(bad));
}

}  // namespace
}  // namespace coupler::generate
