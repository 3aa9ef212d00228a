// SPDX-License-Identifier: Apache-2.0
#include "coupler/map/loader/source_text.hpp"

#include <gtest/gtest.h>

#include "test/common/map/loader/loaded.hpp"

namespace coupler::loader {
namespace {

using namespace std::string_literals;

bool accepted(std::string_view text) {
  Problems problems("map");
  return check_text(text, problems);
}

TEST(SourceText, Utf_8_of_every_length_is_text) {
  EXPECT_TRUE(accepted("a\t\r\n"));
  EXPECT_TRUE(accepted("\u00e9 \u20ac \U0001F600 \U0010FFFF"));
}

TEST(SourceText, What_is_not_utf_8_is_refused) {
  for (const char* text : {"\x80", "\xC0\xAF", "\xE9", "\xE0\x80\x80", "\xED\xA0\x80", "\xF0\x80\x80\x80",
                           "\xF4\x90\x80\x80", "\xF5\x80\x80\x80", "\xE2\x82"})
    EXPECT_FALSE(accepted(text)) << text;
}

TEST(SourceText, Control_characters_are_refused) {
  for (const std::string& text : {"\0"s, "a\x04"s, "\x1B[0m"s, "\x7F"s}) EXPECT_FALSE(accepted(text)) << text;
}

TEST(SourceText, A_position_counts_bytes) {
  EXPECT_EQ(position_of("a\n\u00e9b", 4).line, 2);
  EXPECT_EQ(position_of("a\n\u00e9b", 4).column, 3);
  EXPECT_EQ(position_of("", 0).column, 1);
  EXPECT_EQ(position_of("a", 99).column, 2);
}

TEST(SourceText, A_byte_order_mark_does_not_count) {
  const LoadResult result = load_map("\xEF\xBB\xBFnom: press\nmapping: {coils: {valve: 0}}\n", "map");
  ASSERT_FALSE(result.diagnostics.empty());
  EXPECT_EQ(result.diagnostics[0].column, 1);
}

TEST(SourceText, A_shown_text_is_one_short_line) {
  EXPECT_EQ(shown(std::string_view("a\nb")), "'a b'");
  EXPECT_EQ(shown(std::string(100, 'x')), "'" + std::string(40, 'x') + "...'");
  std::string umlauts;
  for (int i = 0; i < 50; ++i) umlauts += "ü";
  EXPECT_TRUE(accepted(shown(umlauts))) << "no character is cut in two";
}

}  // namespace
}  // namespace coupler::loader
