// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "coupler/map/loader/source_text.hpp"
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

namespace {

std::string blanked(std::string text) {
  Problems problems("map");
  EXPECT_TRUE(blank_comments(text, problems));
  return text;
}

std::string problem_of(std::string text) {
  Problems problems("map");
  EXPECT_FALSE(blank_comments(text, problems));
  return test::text_of(std::move(problems).sorted());
}

TEST(JsonComments, A_document_is_json_if_its_first_character_is_a_brace) {
  EXPECT_TRUE(is_json("{"));
  EXPECT_TRUE(is_json("\n \t// a\n/* b\n c */ # d\n {"));
  EXPECT_FALSE(is_json("name: {"));
  EXPECT_FALSE(is_json("// {\n"));
  EXPECT_FALSE(is_json("/* {"));
  EXPECT_FALSE(is_json(""));
}

TEST(JsonComments, Lines_and_columns_stay) {
  EXPECT_EQ(blanked("{ // a\n \"b\": 1 /* c\n d */ }"), "{     \n \"b\": 1     \n      }");
  EXPECT_EQ(blanked("{// é\r\n}"), "{     \r\n}");
  EXPECT_EQ(blanked("{}/**//**/ //"),
            "{}          "
            " ");
}

TEST(JsonComments, A_string_holds_no_comments) {
  for (const std::string text :
       {R"({"a": "http://b"})", R"({"/* a": '*/'})", R"({"a": "\"// b", "c": '''// d'})"})
    EXPECT_EQ(blanked(text), text);
}

TEST(JsonComments, An_apostrophe_in_bare_text_opens_no_string) {
  EXPECT_EQ(blanked("{a: it's, b: 1} // don't"), "{a: it's, b: 1}         ");
}

TEST(JsonComments, A_quote_in_a_comment_opens_no_string) {
  EXPECT_EQ(blanked("{ # it's \"x\n}"), "{          \n}");
  EXPECT_EQ(blanked("{ /* \" */ }"), "{         }");
}

TEST(JsonComments, What_has_no_end_is_reported_where_it_begins) {
  EXPECT_EQ(problem_of("{\n  \"a\": 1 /* b"),
            "map:2:10: error: the comment '/*' is never closed; end it with '*/'\n");
  EXPECT_EQ(problem_of("{\"a\": \"b\n}"),
            "map:1:7: error: the quote is never closed; close it in the same line\n");
  EXPECT_EQ(problem_of("{\"a\": {\n}"),
            "map:1:1: error: the '{' is never closed; check the brackets that follow\n");
}

TEST(JsonComments, A_document_in_yaml_keeps_its_slashes) {
  const auto owned =
      test::load_clean("name: press\nmapping: {coils: {valve: {address: 0, description: a//b}}}\n");
  EXPECT_EQ(owned->map().points[0].description, "a//b");
}

}  // namespace
}  // namespace coupler::loader
