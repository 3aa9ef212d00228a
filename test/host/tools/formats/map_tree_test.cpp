// SPDX-License-Identifier: Apache-2.0
#include "coupler/tools/formats/map_tree.hpp"

#include <gtest/gtest.h>

#include "coupler/map/loader/document.hpp"
#include "coupler/map/loader/problems.hpp"

namespace coupler::formats {
namespace {

loader::Entry read(const std::string& text) {
  loader::Problems problems("file");
  auto root = loader::parse_document(text, problems);
  EXPECT_TRUE(root) << text;
  return root.value_or(loader::Entry{});
}

TEST(MapWriter, Writes_the_keys_in_the_order_of_the_documentation_and_a_line_a_point) {
  const auto root = read(
      "{mapping: {holding_registers: {speed: {address: 3, type: int}}, coils: {lamp: {address: 1}}, "
      "discrete_inputs: {}}, "
      "rate: 20, name: press}");
  EXPECT_EQ(write_map(root, "From here."),
            "# From here.\n"
            "name: press\n"
            "rate: 20\n"
            "mapping:\n"
            "  coils:\n"
            "    lamp: 1\n"
            "  holding_registers:\n"
            "    speed: {address: 3, type: INT}\n");
}

TEST(MapWriter, Leaves_out_keys_that_no_map_has) {
  EXPECT_EQ(
      write_map(read("{name: a, color: red, mapping: {coils: {x: {address: 1, taste: 2, units: V}}}}"), "c"),
      "# c\nname: a\nmapping:\n  coils:\n    x: {address: 1, units: V}\n");
}

TEST(MapWriter, Texts_read_back_as_they_were_whatever_is_in_them) {
  for (const std::string text : {"plain",
                                 "two words",
                                 "a: b",
                                 "a # b",
                                 "{",
                                 "[x]",
                                 "\"quoted\"",
                                 "it's",
                                 "back\\slash",
                                 "new\nline",
                                 "tab\t",
                                 "5",
                                 "0x10",
                                 "-1",
                                 "true",
                                 "off",
                                 "null",
                                 "~",
                                 "- x",
                                 "? x",
                                 "!tag",
                                 "&a",
                                 "*a",
                                 "%",
                                 "@",
                                 "`",
                                 "\xC2\xB0"
                                 "C",
                                 "a,b",
                                 "",
                                 " ",
                                 "1e5",
                                 "a:",
                                 "#",
                                 "<<"}) {
    loader::Entry list = section("", {1, 1});
    list.children.push_back(scalar("value", text, {1, 1}, true));
    const auto back = read(flow(list));
    ASSERT_EQ(back.children.size(), 1U) << text;
    EXPECT_EQ(back.children[0].text, text);
    EXPECT_EQ(back.children[0].kind, loader::Entry::Kind::scalar) << text;
  }
}

TEST(MapWriter, A_text_that_looks_like_a_number_stays_a_text) {
  EXPECT_EQ(flow(scalar("k", "5", {}, true)), "\"5\"");
  EXPECT_EQ(flow(scalar("k", "5", {}, false)), "5");
  EXPECT_EQ(flow(scalar("k", "on", {}, true)), "\"on\"");
  EXPECT_EQ(flow(scalar("k", "/dev/ttyUSB0", {}, true)), "/dev/ttyUSB0");
}

}  // namespace
}  // namespace coupler::formats
