// SPDX-License-Identifier: Apache-2.0
#include "coupler/map/lock/lock.hpp"

#include <gtest/gtest.h>

namespace coupler::lock {
namespace {

const std::string head = "# anything\n\ncoupler lock 1\n";

std::string problems_of(const std::string& text) {
  std::string all;
  for (const Diagnostic& diagnostic : parse(text, "m.lock").diagnostics) {
    EXPECT_FALSE(diagnostic.remedy.empty());
    all += std::to_string(diagnostic.line) + ":" + std::to_string(diagnostic.column) + ": " +
           diagnostic.what + "\n";
  }
  return all;
}

TEST(Lock, What_is_printed_is_read_again) {
  const Lock lock{{{Table::coils, modbus::Range::of(0, 8)}, "lamps"},
                  {{Table::coils, modbus::Range::of(65535, 1)}, "last", true},
                  {{Table::holding_registers, modbus::Range::of(1, 1), 0xFF00}, "mode"},
                  {{Table::holding_registers, modbus::Range::of(1, 1), 0x0080}, "cell/on"},
                  {{Table::holding_registers, modbus::Range::of(2, 1), 0x00FF}, "level", true},
                  {{Table::holding_registers, modbus::Range::of(4, 4)}, "total"}};
  const Parsed parsed = parse(print(lock), "m.lock");
  EXPECT_TRUE(parsed.diagnostics.empty());
  EXPECT_TRUE(equal(parsed.lock, lock));
  EXPECT_EQ(print(parsed.lock), print(lock));
}

TEST(Lock, Its_lines_are_sorted_by_table_and_place) {
  const Parsed parsed =
      parse(head +
                "holding_registers 3 c\nholding_registers 1.0 b\nholding_registers 1.high a\n"
                "coils 9 d\ncoils 10 e\n",
            "m.lock");
  std::string names;
  for (const Entry& entry : parsed.lock) names += entry.name;
  EXPECT_EQ(names, "deabc");
  const std::string text = print(parsed.lock);
  EXPECT_EQ(text.substr(text.find("coupler lock 1")),
            "coupler lock 1\ncoils 9 d\ncoils 10 e\nholding_registers 1.high a\nholding_registers 1.0 b\n"
            "holding_registers 3 c\n");
}

TEST(Lock, Lines_of_windows_and_further_blanks_are_read) {
  const Parsed parsed = parse("coupler lock 1\r\n  coils \t 3   valve  retired \r\n\r\n", "m.lock");
  ASSERT_TRUE(parsed.diagnostics.empty());
  ASSERT_EQ(parsed.lock.size(), 1U);
  EXPECT_EQ(parsed.lock[0].name, "valve");
  EXPECT_TRUE(parsed.lock[0].retired);
  EXPECT_EQ(parsed.lock[0].line, 2);
}

TEST(Lock, An_empty_file_is_no_lock_as_it_would_move_every_point) {
  EXPECT_EQ(problems_of(""), "1:1: a lock begins with 'coupler lock 1'\n");
  EXPECT_EQ(problems_of("# only\n# comments\n"), "2:1: a lock begins with 'coupler lock 1'\n");
  EXPECT_EQ(problems_of("coils 0 valve\ncoils 1 lamp\n"), "1:1: a lock begins with 'coupler lock 1'\n");
}

TEST(Lock, Another_version_is_refused) {
  EXPECT_EQ(problems_of("coupler lock 2\n"),
            "1:14: the lock has version '2', but this program knows only version 1\n");
}

TEST(Lock, Every_bad_line_is_told_with_its_place) {
  EXPECT_EQ(problems_of(head + "coil 0 a\ncoils x b\ncoils 65536 c\ncoils 3-2 d\ncoils 3.high e\n"
                               "holding_registers 3.16 f\nholding_registers 3.up g\ncoils 4\ncoils 5 h gone\n"
                               "coils 6 i retired j\n"),
            "4:1: 'coil' is not a table\n"
            "5:7: 'x' is not a place in coils\n"
            "6:7: '65536' is not a place in coils\n"
            "7:7: '3-2' is not a place in coils\n"
            "8:7: '3.high' is not a place in coils\n"
            "9:19: '3.16' is not a place in holding_registers\n"
            "10:19: '3.up' is not a place in holding_registers\n"
            "11:1: a line of a lock is TABLE PLACE NAME\n"
            "12:11: 'gone' after the name; only 'retired' may stand there\n"
            "13:11: 'retired' after the name; only 'retired' may stand there\n");
}

TEST(Lock, Two_points_have_no_place_in_common) {
  EXPECT_EQ(problems_of(head + "holding_registers 4-7 a\nholding_registers 7.3 b retired\n"
                               "holding_registers 8.high c\nholding_registers 8.low d\ncoils 4 e\n"),
            "5:1: holding_registers 7.3 of 'b' overlaps holding_registers 4-7 of 'a' (line 4)\n");
  EXPECT_EQ(problems_of(head + "coils 0 b\ncoils 0 a\n"),
            "5:1: coils 0 of 'a' overlaps coils 0 of 'b' (line 4)\n");
}

TEST(Lock, A_conflict_names_both_of_its_lines) {
  for (const std::string lines : {"coils 0-3 a\ncoils 2 b\n", "coils 3 a\ncoils 2 a\n"}) {
    const Diagnostics told = parse(head + lines, "m.yaml.lock").diagnostics;
    ASSERT_EQ(told.size(), 1U);
    EXPECT_EQ(told[0].line, 5);
    ASSERT_EQ(told[0].notes.size(), 1U);
    EXPECT_EQ(told[0].notes[0].line, 4);
  }
}

TEST(Lock, A_name_is_once_in_a_table) {
  EXPECT_EQ(problems_of(head + "coils 3 a\ncoils 2 a\ndiscrete_inputs 0 a\n"),
            "5:1: 'a' is in coils twice, in lines 4 and 5\n");
}

TEST(Lock, What_a_merge_left_is_called_that) {
  EXPECT_EQ(
      problems_of(head + "<<<<<<< HEAD\ncoils 1 a\n||||||| base\n=======\ncoils 2 b\n>>>>>>> topic\n"),
      "4:1: '<<<<<<<' is the marker of a merge conflict\n6:1: '|||||||' is the marker of a merge conflict\n"
      "7:1: '=======' is the marker of a merge conflict\n9:1: '>>>>>>>' is the marker of a merge conflict\n");
}

}  // namespace
}  // namespace coupler::lock
