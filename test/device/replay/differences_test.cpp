// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/replay/differences.hpp"

#include <optional>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "test/device/replay/recording_text.hpp"

namespace coupler::device {
namespace {

using std::chrono::milliseconds;
using testing::ElementsAre;
using testing::IsEmpty;
using Words = std::vector<std::uint16_t>;

const std::string compared_map =
    "name: press\n"
    "mapping:\n"
    "  coils: {lamp: 0, row: {address: 8, count: 2}}\n"
    "  holding_registers:\n"
    "    level: {address: 0, type: INT}\n"
    "    coarse: {address: 1, type: INT, scale: 0.1, publish: on_change, deadband: 0.5}\n"
    "    rough: {address: 2, type: REAL, publish: on_change, deadband: 0.5}\n"
    "    pair: {address: 4, type: INT, count: 2}\n"
    "    text: {address: 6, type: STRING, length: 4, ignore_byteorder: true}\n"
    "    slow: {address: 10, type: INT}\n";

/// Of outputs that are compared within 100 ms, but for `slow`: two periods of 1 s, if the tolerance is 0.
class DifferencesTest : public testing::Test {
 protected:
  explicit DifferencesTest(milliseconds tolerance = milliseconds(100)) { compare(tolerance); }

  void compare(milliseconds tolerance, const std::vector<std::string>& unwanted = {}) {
    std::vector<bool> wanted(recording_.map()->map().points.size(), true);
    for (const std::string& name : unwanted) wanted[played_index(recording_, name)] = false;
    differences_.emplace(recording_, tolerance, wanted);
  }
  void recorded(const std::string& point, const Words& words, int ms) {
    differences_->recorded(played_index(recording_, point), words.data(), milliseconds(ms));
  }
  void written(const std::string& point, const Words& words, int ms) {
    differences_->written(played_index(recording_, point), words.data(), milliseconds(ms));
  }
  /// From the first write on a point is compared.
  void both(const std::string& point, const Words& words, int ms) {
    recorded(point, words, ms);
    written(point, words, ms);
  }
  std::vector<std::string> texts(const std::vector<Differences::Difference>& found) const {
    std::vector<std::string> texts;
    for (const auto& [at, point, what] : found)
      texts.push_back(fmt::format("{}: {}: {}", std::chrono::duration_cast<milliseconds>(at).count(),
                                  recording_.map()->map().points[point].name, what));
    return texts;
  }
  std::vector<std::string> taken(int ms) { return texts(differences_->take(milliseconds(ms))); }
  std::vector<std::string> all() { return texts(differences_->take_all()); }

  static record::Head head() {
    record::Head head = played_head(compared_map);
    head.periods = {{"slow", 1}, {"level", 0.01}};
    return head;
  }
  const Recording recording_ = recording_of_lines("", nullptr, head());
  std::optional<Differences> differences_;
};

TEST_F(DifferencesTest, What_is_written_as_it_was_recorded_is_none) {
  both("level", {1}, 0);
  recorded("level", {2}, 1000);
  written("level", {2}, 1100);
  written("level", {3}, 1900);
  recorded("level", {3}, 2000);
  EXPECT_THAT(all(), IsEmpty());
}

TEST_F(DifferencesTest, What_is_written_too_late_is_missing_and_one_too_many) {
  both("level", {1}, 0);
  recorded("level", {2}, 1000);
  written("level", {2}, 1101);
  EXPECT_THAT(all(), ElementsAre("1000: level: nobody wrote the recorded 2",
                                 "1101: level: the recording does not have the written 2"));
}

TEST_F(DifferencesTest, What_is_written_too_early_is_one_too_many_and_missing) {
  both("level", {1}, 0);
  written("level", {2}, 899);
  recorded("level", {2}, 1000);
  EXPECT_THAT(all(), ElementsAre("899: level: the recording does not have the written 2",
                                 "1000: level: nobody wrote the recorded 2"));
}

TEST_F(DifferencesTest, A_recorded_change_that_nobody_writes_is_told_when_it_is_certain) {
  both("level", {1}, 0);
  recorded("level", {2}, 1000);
  EXPECT_THAT(taken(1100), IsEmpty());
  EXPECT_THAT(taken(1101), ElementsAre("1000: level: nobody wrote the recorded 2"));
  EXPECT_THAT(all(), IsEmpty()) << "it is told once";
}

TEST_F(DifferencesTest, A_write_that_was_not_recorded_is_told_when_it_is_certain) {
  both("level", {1}, 0);
  written("level", {2}, 1000);
  EXPECT_THAT(taken(1100), IsEmpty());
  EXPECT_THAT(taken(1101), ElementsAre("1000: level: the recording does not have the written 2"));
  EXPECT_THAT(all(), IsEmpty()) << "it is told once";
}

TEST_F(DifferencesTest, Another_value_is_both) {
  both("level", {1}, 0);
  recorded("level", {2}, 1000);
  written("level", {0xFFFD}, 1000);
  EXPECT_THAT(all(), ElementsAre("1000: level: nobody wrote the recorded 2",
                                 "1000: level: the recording does not have the written -3"));
}

TEST_F(DifferencesTest, A_value_that_is_written_again_is_no_change) {
  both("level", {1}, 0);
  written("level", {1}, 1000);
  recorded("level", {1}, 2000);
  EXPECT_THAT(all(), IsEmpty());
}

TEST_F(DifferencesTest, Each_change_has_one_partner) {
  both("level", {1}, 0);
  recorded("level", {2}, 1000);
  recorded("level", {1}, 1010);
  recorded("level", {2}, 1020);
  written("level", {2}, 1030);
  EXPECT_THAT(all(), ElementsAre("1010: level: nobody wrote the recorded 1",
                                 "1020: level: nobody wrote the recorded 2"));
}

TEST_F(DifferencesTest, Points_have_nothing_to_do_with_each_other) {
  both("level", {1}, 0);
  both("slow", {1}, 0);
  recorded("level", {2}, 1000);
  written("slow", {2}, 1000);
  EXPECT_THAT(all(), ElementsAre("1000: level: nobody wrote the recorded 2",
                                 "1000: slow: the recording does not have the written 2"));
}

TEST_F(DifferencesTest, All_are_in_the_order_of_their_times) {
  both("level", {1}, 0);
  both("lamp", {0}, 0);
  recorded("lamp", {1}, 3000);
  recorded("level", {2}, 1000);
  written("level", {3}, 2000);
  EXPECT_THAT(all(), ElementsAre("1000: level: nobody wrote the recorded 2",
                                 "2000: level: the recording does not have the written 3",
                                 "3000: lamp: nobody wrote the recorded true"));
}

TEST_F(DifferencesTest, Before_the_first_write_nothing_counts) {
  recorded("level", {1}, 0);
  recorded("level", {2}, 1000);
  recorded("level", {3}, 2000);
  EXPECT_FALSE(differences_->is_written(played_index(recording_, "level")));
  EXPECT_THAT(taken(5000), IsEmpty());
  EXPECT_THAT(all(), IsEmpty());
  written("level", {3}, 6000);
  EXPECT_TRUE(differences_->is_written(played_index(recording_, "level")));
  EXPECT_THAT(all(), IsEmpty()) << "it is what the recording has had for long";
}

TEST_F(DifferencesTest, A_first_write_of_another_value_is_one) {
  recorded("level", {1}, 0);
  written("level", {2}, 1000);
  EXPECT_THAT(all(), ElementsAre("1000: level: the recording does not have the written 2"));
}

TEST_F(DifferencesTest, A_first_write_may_be_early_or_late_as_any_other) {
  recorded("level", {1}, 0);
  written("level", {2}, 1000);
  recorded("level", {2}, 1100);
  recorded("lamp", {0}, 0);
  recorded("lamp", {1}, 2000);
  recorded("lamp", {0}, 2050);
  written("lamp", {1}, 2090);
  written("lamp", {0}, 2100);
  EXPECT_THAT(all(), IsEmpty());
}

TEST_F(DifferencesTest, What_was_recorded_shortly_before_the_first_write_needs_no_partner) {
  recorded("level", {1}, 0);
  written("level", {2}, 30);
  recorded("level", {2}, 50);
  recorded("slow", {1}, 1000);
  recorded("slow", {2}, 1010);
  written("slow", {1}, 1020);
  written("slow", {2}, 1030);
  EXPECT_THAT(all(), IsEmpty());
}

TEST_F(DifferencesTest, The_value_with_which_a_recording_begins_is_no_change) {
  written("level", {2}, 1);
  recorded("level", {1}, 0);
  recorded("level", {2}, 50);
  EXPECT_THAT(all(), IsEmpty());
}

TEST_F(DifferencesTest, What_the_recording_has_no_value_of_is_not_compared) {
  written("level", {1}, 1000);
  written("level", {2}, 2000);
  EXPECT_THAT(taken(5000), IsEmpty());
  EXPECT_THAT(all(), IsEmpty());
}

TEST_F(DifferencesTest, Points_that_are_not_wanted_never_count) {
  compare(milliseconds(100), {"level"});
  both("level", {1}, 0);
  both("slow", {1}, 0);
  recorded("level", {2}, 1000);
  written("level", {3}, 1000);
  recorded("slow", {2}, 1000);
  EXPECT_TRUE(differences_->is_written(played_index(recording_, "level")));
  EXPECT_THAT(taken(5000), ElementsAre("1000: slow: nobody wrote the recorded 2"));
}

TEST_F(DifferencesTest, Within_the_deadband_numbers_are_equal) {
  both("coarse", {100}, 0);
  recorded("coarse", {200}, 1000);
  written("coarse", {205}, 1000);
  both("rough", {0, 0x3F80}, 0);         // 1
  recorded("rough", {0, 0x4000}, 1000);  // 2
  written("rough", {0, 0x4020}, 1000);   // 2.5
  EXPECT_THAT(all(), IsEmpty());
  recorded("coarse", {300}, 2000);
  written("coarse", {306}, 2000);
  EXPECT_THAT(all(), ElementsAre("2000: coarse: nobody wrote the recorded 30",
                                 "2000: coarse: the recording does not have the written 30.6"));
}

TEST_F(DifferencesTest, A_first_write_within_the_deadband_is_none) {
  recorded("coarse", {100}, 0);
  written("coarse", {105}, 5000);
  EXPECT_THAT(all(), IsEmpty());
}

TEST_F(DifferencesTest, Not_a_number_equals_itself_and_nothing_else) {
  both("rough", {0, 0x3F80}, 0);
  recorded("rough", {0, 0x7FC0}, 1000);
  written("rough", {0, 0x7FC0}, 1000);
  EXPECT_THAT(all(), IsEmpty());
  recorded("rough", {0, 0x4000}, 2000);
  written("rough", {1, 0x7FC0}, 2000);
  EXPECT_EQ(all().size(), 2U);
}

TEST_F(DifferencesTest, Values_are_told_as_people_read_them) {
  for (const auto& [point, first] : {std::pair<std::string, Words>("lamp", {0}),
                                     {"row", {0, 0}},
                                     {"coarse", {0}},
                                     {"rough", {0, 0}},
                                     {"pair", {0, 0}},
                                     {"text", {0, 0}}})
    both(point, first, 0);
  recorded("lamp", {1}, 1000);
  recorded("row", {0, 1}, 2000);
  recorded("coarse", {217}, 3000);
  recorded("rough", {0xF5C3, 0x4048}, 4000);
  recorded("pair", {5, 0xFFFF}, 5000);
  recorded("text", {0x6F6B, 0}, 6000);
  EXPECT_THAT(all(), ElementsAre("1000: lamp: nobody wrote the recorded true",
                                 "2000: row: nobody wrote the recorded false true",
                                 "3000: coarse: nobody wrote the recorded 21.7",
                                 "4000: rough: nobody wrote the recorded 3.14",
                                 "5000: pair: nobody wrote the recorded 5 -1",
                                 "6000: text: nobody wrote the recorded ok"));
}

TEST_F(DifferencesTest, Without_a_tolerance_it_is_two_periods_of_the_point_or_200_ms) {
  compare(milliseconds(0));
  for (const char* point : {"slow", "level", "lamp"}) {
    both(point, {0}, 0);
    recorded(point, {1}, 10000);
  }
  written("level", {1}, 10021);
  written("lamp", {1}, 10200);
  written("slow", {1}, 12000);
  EXPECT_THAT(all(), ElementsAre("10000: level: nobody wrote the recorded 1",
                                 "10021: level: the recording does not have the written 1"));
}

TEST_F(DifferencesTest, What_has_no_partner_may_get_one_until_its_tolerance_is_over) {
  both("level", {1}, 0);
  EXPECT_EQ(differences_->open_until(), milliseconds(0));
  recorded("level", {2}, 1000);
  EXPECT_EQ(differences_->open_until(), milliseconds(1100));
  written("level", {2}, 1050);
  EXPECT_EQ(differences_->open_until(), milliseconds(0));
}

TEST_F(DifferencesTest, Outputs_that_changed_and_nobody_wrote_are_known) {
  recorded("level", {1}, 0);
  recorded("rough", {0, 0}, 0);
  EXPECT_THAT(differences_->unwritten(), IsEmpty());
  recorded("level", {2}, 1000);
  EXPECT_THAT(differences_->unwritten(), ElementsAre(played_index(recording_, "level")));
  written("level", {2}, 1000);
  EXPECT_THAT(differences_->unwritten(), IsEmpty());
}

TEST_F(DifferencesTest, The_way_back_to_the_beginning_is_none) {
  both("level", {1}, 0);
  both("level", {2}, 1000);
  EXPECT_THAT(all(), IsEmpty());
  differences_->begin_again();
  recorded("level", {1}, 0);
  EXPECT_THAT(taken(500), IsEmpty());
  recorded("level", {2}, 1000);
  EXPECT_THAT(all(), ElementsAre("1000: level: nobody wrote the recorded 2"));
}

}  // namespace
}  // namespace coupler::device
