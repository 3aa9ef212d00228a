// SPDX-License-Identifier: Apache-2.0
#include "coupler/map/escape.hpp"

#include <gtest/gtest.h>

namespace coupler {
namespace {

TEST(Escape, No_text_opens_an_element_or_ends_an_attribute_of_html) {
  EXPECT_EQ(html("</td><script>\"a\" & 'b'"), "&lt;/td&gt;&lt;script&gt;&quot;a&quot; &amp; &#39;b&#39;");
  EXPECT_EQ(html("two\nlines\x7f"), "two lines ");
}

TEST(Escape, No_text_ends_a_cell_or_begins_anything_in_markdown) {
  EXPECT_EQ(markdown("a|b"), "a\\|b");
  EXPECT_EQ(markdown("`rm` **x** _y_ [z](u) \\|"), "\\`rm\\` \\*\\*x\\*\\* \\_y\\_ \\[z\\](u) \\\\\\|");
  EXPECT_EQ(markdown("<b>&amp;"), "&lt;b&gt;&amp;amp;");
  EXPECT_EQ(markdown("two\r\nlines"), "two  lines");
  EXPECT_EQ(markdown("20 °C"), "20 °C");
}

TEST(Escape, What_turns_the_direction_of_writing_is_shown_as_its_number) {
  EXPECT_EQ(html("on\u202Effo"), "onU+202Effo");
  EXPECT_EQ(markdown("on\u2066ffo"), "onU+2066ffo");
  EXPECT_EQ(one_line("on\u200Fffo\n"), "onU+200Fffo ");
}

TEST(Escape, A_path_in_a_url_keeps_its_folders_only) {
  EXPECT_EQ(url_path("../my maps/ä#1.yaml"), "../my%20maps/%C3%A4%231.yaml");
}

}  // namespace
}  // namespace coupler
