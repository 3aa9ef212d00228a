// SPDX-License-Identifier: Apache-2.0
#include "coupler/tools/formats/csv.hpp"

#include "coupler/base/csv_cell.hpp"

#include <gmock/gmock.h>

namespace coupler::formats {
namespace {

using testing::ElementsAre;

std::vector<std::vector<std::string>> parsed(std::string_view text) {
  loader::Problems problems("file");
  std::vector<std::vector<std::string>> rows;
  for (const Row& row : parse_csv(text, problems)) {
    rows.emplace_back();
    for (const Cell& cell : row) rows.back().push_back(cell.text);
  }
  EXPECT_FALSE(problems.has_errors());
  return rows;
}

std::string refused(std::string_view text) {
  loader::Problems problems("file");
  EXPECT_TRUE(parse_csv(text, problems).empty());
  const Diagnostics found = std::move(problems).sorted();
  return found.empty() ? "" : to_string(found[0]);
}

TEST(Csv, The_example_of_RFC_4180_section_2_is_read_as_it_says) {
  EXPECT_THAT(parsed("aaa,bbb,ccc\r\nzzz,yyy,xxx"),
              ElementsAre(ElementsAre("aaa", "bbb", "ccc"), ElementsAre("zzz", "yyy", "xxx")));
  EXPECT_THAT(parsed("\"aaa\",\"b\r\nbb\",\"ccc\"\r\nzzz,yyy,xxx"),
              ElementsAre(ElementsAre("aaa", "b\r\nbb", "ccc"), ElementsAre("zzz", "yyy", "xxx")));
  EXPECT_THAT(parsed("\"aaa\",\"b\"\"bb\",\"ccc\""), ElementsAre(ElementsAre("aaa", "b\"bb", "ccc")));
}

TEST(Csv, The_separator_is_the_one_that_the_first_line_has_most_of) {
  EXPECT_THAT(parsed("a;b;c\n1,5;2;3\n"),
              ElementsAre(ElementsAre("a", "b", "c"), ElementsAre("1,5", "2", "3")));
  EXPECT_THAT(parsed("a\tb\n1;2\t3"), ElementsAre(ElementsAre("a", "b"), ElementsAre("1;2", "3")));
  EXPECT_THAT(parsed("\"a;;;\",b\n"), ElementsAre(ElementsAre("a;;;", "b")));
}

TEST(Csv, Blanks_around_cells_and_empty_lines_do_not_count) {
  EXPECT_THAT(parsed("\n a , \"b \" ,c\n,,\n\n1,,\n"),
              ElementsAre(ElementsAre("a", "b ", "c"), ElementsAre("1", "", "")));
}

TEST(Csv, Cells_know_their_line_and_column) {
  loader::Problems problems("file");
  const auto rows = parse_csv("a,b\n\"x\ny\", z\nlast,1", problems);
  ASSERT_EQ(rows.size(), 3U);
  EXPECT_EQ(rows[1][1].at.line, 3);
  EXPECT_EQ(rows[1][1].at.column, 5);
  EXPECT_EQ(rows[2][1].at.line, 4);
  EXPECT_EQ(rows[2][1].at.column, 6);
}

TEST(Csv, An_open_quote_and_text_behind_a_closed_one_are_told_where_they_are) {
  EXPECT_EQ(refused("a,b\nc,\"d\n\n"),
            "file:2:3: error: the quote is never closed; close it where the cell ends");
  EXPECT_EQ(refused("a,\"b\"c\n"),
            "file:1:6: error: there is text after the closing quote; inside quotes, write a quote twice");
}

TEST(Csv, What_is_written_as_a_cell_reads_back) {
  for (const std::string text :
       {"plain", "a,b", "a;b", "say \"hi\"", "two\nlines", " blanks ", "tab\there", "\"", "°C"})
    EXPECT_THAT(parsed(csv_cell(text) + ",x"), ElementsAre(ElementsAre(text, "x")));
}

TEST(Csv, Text_that_a_spreadsheet_would_run_gets_an_apostrophe_and_loses_it_again) {
  for (const std::string text : {"=1+1", "+49 151", "-flow", "@home", "'=1", "''-x", "\t=1"}) {
    EXPECT_EQ(guarded(text), "'" + text);
    EXPECT_EQ(unguarded(guarded(text)), text);
  }
  for (const std::string text : {"", "'", "'quoted'", "a=1", "°C", "5-6"}) {
    EXPECT_EQ(guarded(text), text);
    EXPECT_EQ(unguarded(text), text);
  }
}

}  // namespace
}  // namespace coupler::formats
