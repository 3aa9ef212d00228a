// SPDX-License-Identifier: Apache-2.0
#include "coupler/map/loader/without_keys.hpp"

#include <string>

#include <gtest/gtest.h>

#include "test/common/map/loader/loaded.hpp"

namespace coupler {
namespace {

std::string without_secrets(const std::string& text) { return without_keys(text, {"security", "tls"}); }

/// What is left of a map that is secured: it loads, has the same points, and is not secured any more.
std::string left_of(const std::string& text) {
  const MapPtr whole = test::load_clean(text);
  EXPECT_TRUE(whole->map().security.present() || whole->map().connection.tls.present()) << text;
  const std::string left = without_secrets(text);
  const MapPtr bare = test::load_clean(left);
  EXPECT_EQ(bare->map().name, whole->map().name);
  EXPECT_EQ(bare->map().points.size(), whole->map().points.size());
  EXPECT_EQ(bare->map().fingerprint, whole->map().fingerprint);
  EXPECT_FALSE(bare->map().security.present());
  EXPECT_FALSE(bare->map().connection.tls.present());
  return left;
}

const std::string block_mapping =
    "mapping:\n"
    "  coils: {lamp: 0}\n";
const std::string block_security =
    "security:\n"
    "  roles:\n"
    "    viewer: {read: all}\n"
    "  plain: viewer\n";

TEST(WithoutKeys, In_block_style_the_lines_of_the_key_go_wherever_they_stand) {
  const std::string left = "name: cell\n" + block_mapping;
  EXPECT_EQ(left_of(block_security + "name: cell\n" + block_mapping), left);
  EXPECT_EQ(left_of("name: cell\n" + block_security + block_mapping), left);
  EXPECT_EQ(left_of("name: cell\n" + block_mapping + block_security), left);
}

TEST(WithoutKeys, Of_several_keys_each_goes) {
  EXPECT_EQ(left_of("tls: {certificate: a.pem, key: a.key, ca: ca.pem}\n" + block_security + "name: cell\n" +
                    block_mapping),
            "name: cell\n" + block_mapping);
  EXPECT_EQ(left_of("{name: cell, tls: {certificate: a.pem, key: a.key, ca: ca.pem}, security: {roles: "
                    "{viewer: {read: all}}}, mapping: {coils: {lamp: 0}}}"),
            "{name: cell, mapping: {coils: {lamp: 0}}}");
}

TEST(WithoutKeys, In_braces_the_entry_goes_with_one_comma) {
  const std::string left = R"({"name": "cell", "mapping": {"coils": {"lamp": 0}}})";
  const std::string security = R"("security": {"roles": {"viewer": {"read": "all"}}, "plain": "viewer"})";
  EXPECT_EQ(left_of("{" + security + R"(, "name": "cell", "mapping": {"coils": {"lamp": 0}}})"), left);
  EXPECT_EQ(left_of(R"({"name": "cell", )" + security + R"(, "mapping": {"coils": {"lamp": 0}}})"), left);
  EXPECT_EQ(left_of(R"({"name": "cell", "mapping": {"coils": {"lamp": 0}}, )" + security + "}"), left);
}

TEST(WithoutKeys, JSON_of_several_lines_is_JSON_again) {
  EXPECT_EQ(left_of("{\n"
                    "  \"name\": \"cell\",\n"
                    "  \"mapping\": {\"coils\": {\"lamp\": 0}},\n"
                    "  \"security\": {\n"
                    "    \"roles\": {\"viewer\": {\"read\": \"all\"}}\n"
                    "  }\n"
                    "}\n"),
            "{\n"
            "  \"name\": \"cell\",\n"
            "  \"mapping\": {\"coils\": {\"lamp\": 0}}}\n");
}

TEST(WithoutKeys, Commas_and_braces_in_comments_are_none) {
  EXPECT_EQ(left_of("{ // a map {of a cell},\n"
                    "  name: cell,\n"
                    "  mapping: {coils: {lamp: 0}}, /* who, and what } */\n"
                    "  security: {roles: {viewer: {read: all}}} // the end, }\n"
                    "} // }, of all\n"),
            "{ // a map {of a cell},\n"
            "  name: cell,\n"
            "  mapping: {coils: {lamp: 0}}} // }, of all\n");
}

TEST(WithoutKeys, Of_a_key_alone_nothing_is_left) {
  EXPECT_EQ(without_secrets(block_security), "");
  EXPECT_EQ(without_secrets("{security: {plain: viewer}}"), "{}");
}

TEST(WithoutKeys, Comments_above_the_key_stay_and_those_above_the_next_one_go_with_it) {
  EXPECT_EQ(left_of("# the cell\n"
                    "name: cell  # in hall 3\n"
                    "# who may do what\n" +
                    block_security + "# all points\n" + block_mapping),
            "# the cell\n"
            "name: cell  # in hall 3\n"
            "# who may do what\n" +
                block_mapping);
}

TEST(WithoutKeys, A_key_of_that_name_further_down_stays) {
  const std::string block =
      "name: cell\n"
      "mapping:\n"
      "  coils:\n"
      "    security: 0\n"
      "    tls: 1\n";
  EXPECT_EQ(without_secrets(block), block);
  EXPECT_EQ(left_of(block + block_security), block);
  const std::string braced = "{name: cell, mapping: {coils: {security: 0, tls: 1}}}";
  EXPECT_EQ(without_secrets(braced), braced);
}

TEST(WithoutKeys, A_text_that_has_none_of_them_stays_byte_for_byte) {
  for (const std::string text : {"name: cell\r\n\r\n# security: none\r\nmapping: {coils: {lamp: 0}}",
                                 "{\"name\": \"security: {\", \"mapping\": {\"coils\": {\"lamp\": 0}} }\n\n"})
    EXPECT_EQ(without_secrets(text), text);
}

TEST(WithoutKeys, A_byte_order_mark_goes) {
  const std::string mark = "\xEF\xBB\xBF";
  EXPECT_EQ(left_of(mark + block_security + "name: cell\n" + block_mapping), "name: cell\n" + block_mapping);
  EXPECT_EQ(
      left_of(mark + "{security: {roles: {viewer: {read: all}}}, name: cell, mapping: {coils: {lamp: 0}}}"),
      "{name: cell, mapping: {coils: {lamp: 0}}}");
}

TEST(WithoutKeys, Characters_of_several_bytes_move_nothing) {
  EXPECT_EQ(
      left_of("{name: cell, /* f\u00fcr \u20ac */ security: {roles: {pr\u00fcfer: {read: all}}}, mapping: "
              "{coils: {lamp: {address: 0, description: '\u00fc'}}}}"),
      "{name: cell, /* f\u00fcr \u20ac */ mapping: {coils: {lamp: {address: 0, description: '\u00fc'}}}}");
}

TEST(WithoutKeys, Lines_may_end_in_CR_LF_and_keys_stand_in_quotes) {
  EXPECT_EQ(left_of("name: cell\r\n\"security\":\r\n  roles: {viewer: {read: all}}\r\n'mapping':\r\n  coils: "
                    "{lamp: 0}\r\n"),
            "name: cell\r\n'mapping':\r\n  coils: {lamp: 0}\r\n");
}

TEST(WithoutKeys, A_map_may_be_indented_as_a_whole) {
  EXPECT_EQ(left_of("  name: cell\n"
                    "  security: {roles: {viewer: {read: all}}}\n"
                    "  mapping: {coils: {lamp: 0}}\n"),
            "  name: cell\n"
            "  mapping: {coils: {lamp: 0}}\n");
}

TEST(WithoutKeys, Braces_may_stand_behind_the_mark_of_a_document) {
  EXPECT_EQ(
      left_of("--- {name: cell, security: {roles: {viewer: {read: all}}}, mapping: {coils: {lamp: 0}}}\n"),
      "--- {name: cell, mapping: {coils: {lamp: 0}}}\n");
  EXPECT_EQ(
      left_of("---\n{name: cell, mapping: {coils: {lamp: 0}}, security: {roles: {viewer: {read: all}}}}\n"),
      "---\n{name: cell, mapping: {coils: {lamp: 0}}}\n");
}

TEST(WithoutKeys, A_key_may_stand_behind_a_question_mark) {
  EXPECT_EQ(left_of("name: cell\n"
                    "? security\n"
                    ": {roles: {viewer: {read: all}}}\n" +
                    block_mapping),
            "name: cell\n" + block_mapping);
}

}  // namespace
}  // namespace coupler
