// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "coupler/map/diagnostic.hpp"

namespace coupler {
namespace {

using Severity = Diagnostic::Severity;

TEST(Diagnostic, It_reads_as_compilers_write_it) {
  EXPECT_EQ(to_string(Diagnostic{Severity::error, "a.yaml", 7, 11, "this is wrong", "do that"}),
            "a.yaml:7:11: error: this is wrong; do that");
  EXPECT_EQ(to_string(Diagnostic{Severity::warning, "a.yaml", 1, 1, "this is odd", "look"}),
            "a.yaml:1:1: warning: this is odd; look");
}

TEST(Diagnostic, About_a_whole_file_it_has_no_place) {
  EXPECT_EQ(to_string(Diagnostic{Severity::error, "a.yaml", 0, 0, "no such file", "look"}),
            "a.yaml: error: no such file; look");
}

TEST(Diagnostic, A_text_that_says_what_to_do_stands_alone) {
  const Diagnostic error{Severity::error, "tls://press", 0, 0, "it is for another name; give that", ""};
  EXPECT_EQ(to_string(error), "tls://press: error: it is for another name; give that");
  EXPECT_EQ(render(error, Colour::no), "tls://press: error: it is for another name; give that\n");
}

/// `errors` and `warnings`, in turn as long as there are both.
Diagnostics many(int errors, int warnings) {
  Diagnostics all;
  for (int line = 1; errors > 0 || warnings > 0; ++line) {
    if (warnings-- > 0) all.push_back({Diagnostic::Severity::warning, "m", line, 1, "w", "x"});
    if (errors-- > 0) all.push_back({Diagnostic::Severity::error, "m", line, 1, "e", "x"});
  }
  return all;
}

TEST(Shortened, A_hundred_are_kept_and_the_last_one_says_how_many_there_are_more) {
  EXPECT_EQ(shortened(many(60, 40)).size(), 100U);
  const Diagnostics short_of_250 = shortened(many(50, 200));
  ASSERT_EQ(short_of_250.size(), 101U);
  EXPECT_EQ(to_string(short_of_250.back()),
            "m: warning: 0 more errors and 150 more warnings are not shown; mend those above first");
  EXPECT_EQ(short_of_250.front().what, "w") << "in their order";
  EXPECT_EQ(short_of_250[99].what, "e") << "every error is there";
}

TEST(Shortened, Errors_go_before_warnings) {
  const Diagnostics kept = shortened(many(130, 200));
  EXPECT_EQ(kept[0].what, "e");
  EXPECT_EQ(kept[99].line, 100);
  EXPECT_EQ(to_string(kept.back()),
            "m: error: 30 more errors and 200 more warnings are not shown; mend those above first");
}

TEST(Diagnostic, Warnings_are_no_errors) {
  Diagnostics found{{Severity::warning, "a.yaml", 1, 1, "this is odd", "look"}};
  EXPECT_FALSE(has_errors(found));
  found.push_back({Severity::error, "a.yaml", 1, 1, "this is wrong", "do that"});
  EXPECT_TRUE(has_errors(found));
}

}  // namespace

namespace {

/// As it is shown to people when line 2 of a file is `line`.
std::string shown(const std::string& line, int column) {
  Diagnostics found{{Severity::error, "a.yaml", 2, column, "this is wrong", "do that"}};
  quote(found, "first\n" + line + "\nthird\n");
  return render(found[0], Colour::no);
}

TEST(Render, The_place_is_marked_to_the_end_of_its_word) {
  EXPECT_EQ(shown("  coils: {lamp: 0}", 11),
            "a.yaml:2:11: error: this is wrong; do that\n"
            "    2 |   coils: {lamp: 0}\n"
            "      |           ^~~~\n");
}

TEST(Render, Its_first_line_is_what_programs_read) {
  Diagnostic d{Severity::warning, "a.yaml", 7, 1, "this is odd", "look"};
  EXPECT_EQ(render(d, Colour::no), to_string(d) + "\n");
  d.line = 0;
  EXPECT_EQ(render(d, Colour::no), "a.yaml: warning: this is odd; look\n");
}

TEST(Render, A_tab_is_below_a_tab) {
  EXPECT_EQ(shown("\ta:\tb", 5),
            "a.yaml:2:5: error: this is wrong; do that\n"
            "    2 | \ta:\tb\n"
            "      | \t  \t^\n");
}

TEST(Render, Characters_are_as_wide_as_a_terminal_shows_them) {
  EXPECT_NE(shown("\u00e4: b", 5).find("\n      |    ^\n"), std::string::npos);  // two bytes, one column
  EXPECT_NE(shown("\u6e29\u5ea6: b", 9).find("\n      |       ^\n"), std::string::npos);  // three, two
  EXPECT_NE(shown("a\u0301: b", 6).find("\n      |    ^\n"), std::string::npos);  // a combining accent
  EXPECT_NE(shown("x: \u00e4\u00f6\u00fc", 4).find("\n      |    ^~~\n"), std::string::npos);
}

TEST(Render, Behind_the_last_character_there_is_a_caret_too) {
  EXPECT_NE(shown("name:", 6).find("\n    2 | name:\n      |      ^\n"), std::string::npos);
  EXPECT_NE(shown("name:", 60).find("\n      |      ^\n"), std::string::npos);
}

TEST(Render, Nothing_in_a_file_steers_the_terminal) {
  const std::string text = shown("a: \x1b[31m\x7f\xc2\x9b \xff\xfe\x80 b", 1);
  EXPECT_NE(text.find("    2 | a:  [31m    ??? b\n"), std::string::npos) << text;
}

TEST(Render, Nothing_in_a_message_steers_the_terminal) {
  Diagnostic d{Severity::error, "\x1b.yaml", 2, 3, "'\u009B2J' is wrong", "remove \u202E", {}, {}};
  d.notes.push_back({1, 1, "\xFF is here", {}});
  EXPECT_EQ(
      render(d, Colour::no),
      "\\x1b.yaml:2:3: error: '\\x9b2J' is wrong; remove \\u202e\n\\x1b.yaml:1:1: note: \\xff is here\n");
  EXPECT_EQ(to_string(d), "\\x1b.yaml:2:3: error: '\\x9b2J' is wrong; remove \\u202e");
}

TEST(Render, What_turns_the_direction_of_writing_is_a_gap_as_wide_in_bytes) {
  EXPECT_NE(shown("a: \u202Eb c", 8).find("    2 | a:    b c\n"), std::string::npos)
      << shown("a: \u202Eb c", 8);
}

TEST(Render, Of_a_long_line_the_surroundings_are_shown) {
  const std::string far(1000, 'x');
  const std::string text = shown(far + " \u00e4lamp " + far, 1002);
  EXPECT_LT(text.size(), 500U);
  EXPECT_NE(text.find("    2 | ...xxx"), std::string::npos) << text;
  EXPECT_NE(text.find(" \u00e4lamp xxx"), std::string::npos) << text;
  EXPECT_NE(text.find("^~~~~\n"), std::string::npos) << text;
}

TEST(Render, A_long_line_is_never_cut_inside_a_character) {
  std::string line;
  for (int i = 0; i < 200; ++i) line += "\u6e29";
  for (int column = 1; column <= 600; column += 3)
    EXPECT_EQ(shown(line, column).find('?'), std::string::npos);
}

TEST(Render, Lines_may_end_as_on_Windows) {
  Diagnostics found{{Severity::error, "a.yaml", 1, 1, "this is wrong", "do that"}};
  quote(found, "name: x\r\nport: 1\r\n");
  EXPECT_NE(render(found[0], Colour::no).find("    1 | name: x\n"), std::string::npos);
}

TEST(Render, Both_places_of_a_conflict_are_shown) {
  Diagnostics found{
      {Severity::error, "a.yaml", 2, 4, "b overlaps a", "move it", {{1, 4, "the other is here"}}}};
  quote(found, "a: 0\nb: 0\n");
  EXPECT_EQ(render(found[0], Colour::no),
            "a.yaml:2:4: error: b overlaps a; move it\n"
            "    2 | b: 0\n"
            "      |    ^\n"
            "a.yaml:1:4: note: the other is here\n"
            "    1 | a: 0\n"
            "      |    ^\n");
}

TEST(Render, Colours_change_no_word) {
  Diagnostics found{{Severity::error, "a.yaml", 1, 1, "this is wrong", "do that", {{1, 4, "here"}}}};
  quote(found, "a: 0\n");
  std::string coloured = render(found[0], Colour::yes);
  EXPECT_NE(coloured.find("\033[1;31merror:\033[0m"), std::string::npos);
  for (std::size_t at = 0; (at = coloured.find('\033')) != std::string::npos;)
    coloured.erase(at, coloured.find('m', at) - at + 1);
  EXPECT_EQ(coloured, render(found[0], Colour::no));
}

}  // namespace
}  // namespace coupler
