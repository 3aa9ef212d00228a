// SPDX-License-Identifier: Apache-2.0
#include "coupler/map/loader/json_comments.hpp"

#include <gtest/gtest.h>

#include "test/common/map/loader/loaded.hpp"

namespace coupler::loader {
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
            "map:1:1: error: the '{' is never closed; count the brackets that follow\n");
}

TEST(JsonComments, A_document_in_yaml_keeps_its_slashes) {
  const auto owned =
      test::load_clean("name: press\nmapping: {coils: {valve: {address: 0, description: a//b}}}\n");
  EXPECT_EQ(owned->map().points[0].description, "a//b");
}

}  // namespace
}  // namespace coupler::loader
