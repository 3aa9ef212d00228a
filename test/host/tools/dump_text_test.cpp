// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include "coupler/tools/dump_output.hpp"
#include "test/fakes/map_builder.hpp"

namespace coupler::tools {
namespace {

using codec::Type;
using fakes::MapBuilder;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using State = Reading::State;

constexpr std::chrono::system_clock::time_point noon{std::chrono::milliseconds(1'795'262'400'123)};
constexpr auto noon_text = "2026-11-21T12:00:00.123Z";

class DumpText : public testing::Test {
 protected:
  DumpText() {
    builder.add(Table::coils, "lamp", 0, Type::BOOL)
        .add(Table::coils, "horn", 1, Type::BOOL, [](Point& point) { point.access = Access::write; })
        .add(Table::input_registers, "level", 3, Type::INT, [](Point& point) {
          point.units = "°C";
          point.scale.gain = 0.5;
        });
    builder.head().connection.address = "cell";
    owned = builder.build();
    now.at = noon;
    now.readings = {{0, State::good, {1}}, {1, State::not_asked, {}, "write-only"}, {2, State::good, {43}}};
  }
  const Map& map() const { return owned->map(); }

  MapBuilder builder{"press"};
  MapPtr owned;
  Snapshot now;
};

TEST_F(DumpText, The_table_names_the_device_and_has_a_line_for_each_point) {
  EXPECT_THAT(table_lines(map(), now, Colour::no),
              ElementsAre("press at tcp://cell:502/1, 2026-11-21T12:00:00.123Z: 3 points",
                          "  point  value    type  table            address  Modicon",
                          "  lamp   true     BOOL  coils            0        00001",
                          "  horn   -        BOOL  coils            1        00002    write-only",
                          "  level  21.5 °C  INT   input_registers  3        30004"));
}

TEST_F(DumpText, A_point_that_was_not_read_says_why_and_is_counted) {
  now.readings[0] = {0, State::failed, {}, "exception 02 (illegal data address)"};
  const auto lines = table_lines(map(), now, Colour::no);
  EXPECT_THAT(lines[0], HasSubstr("1 of 3 points not read"));
  EXPECT_THAT(lines[2], HasSubstr("not read: exception 02 (illegal data address)"));
}

TEST_F(DumpText, What_has_changed_is_marked_and_bold_with_colours) {
  now.readings[2].changed = true;
  EXPECT_EQ(table_lines(map(), now, Colour::no)[4].substr(0, 7), "* level");
  EXPECT_EQ(table_lines(map(), now, Colour::yes)[4].substr(0, 11), "\033[1m* level");
  EXPECT_EQ(table_lines(map(), now, Colour::yes)[2].substr(0, 6), "  lamp");
}

TEST_F(DumpText, Notes_stand_below_the_table) {
  now.notes = {"first\n  second"};
  const auto lines = table_lines(map(), now, Colour::no);
  EXPECT_EQ(lines[lines.size() - 2], "first");
  EXPECT_EQ(lines.back(), "  second");
}

TEST_F(DumpText, An_offline_device_is_called_so_in_the_first_line) {
  now.error = host::Timeout{std::chrono::milliseconds(9)};
  EXPECT_THAT(table_lines(map(), now, Colour::no)[0], HasSubstr(": offline: no reply within 9 ms"));
}

TEST_F(DumpText, A_terminal_does_not_obey_the_text_of_a_device) {
  MapBuilder texts;
  texts.add(Table::holding_registers, "label", 0, Type::STRING, [](Point& point) {
    point.format.length = 6;
    point.format.order = codec::Order::ABCD;
  });
  const MapPtr label = texts.build();
  const Reading reading{0, State::good, {0x411B, 0x5B32, 0x4A0A}};
  EXPECT_EQ(value_text(label->map(), reading), "\"A\\x1b[2J\\x0a\"");

  // In Latin-1, 9B is a control character, too.
  MapBuilder latin;
  latin.add(Table::holding_registers, "label", 0, Type::STRING, [](Point& point) {
    point.format.length = 3;
    point.format.order = codec::Order::ABCD;
    point.format.encoding = codec::Encoding::latin1;
  });
  const MapPtr other = latin.build();
  EXPECT_EQ(value_text(other->map(), Reading{0, State::good, {0x9BB0, 0x4100}}), "\"\\x9b°A\"");
}

TEST_F(DumpText, A_terminal_does_not_obey_a_map) {
  MapBuilder units;
  units.add(Table::holding_registers, "level", 0, Type::UINT,
            [](Point& point) { point.units = "\u009B2J\u202E\x1B"; });
  const MapPtr hostile = units.build();
  EXPECT_EQ(value_text(hostile->map(), Reading{0, State::good, {7}}), "7 \\x9b2J\\u202e\\x1b");
}

TEST_F(DumpText, A_long_value_does_not_push_the_others_aside) {
  MapBuilder arrays;
  arrays.add(Table::holding_registers, "many", 0, Type::UINT, [](Point& point) { point.count = 20; })
      .add(Table::holding_registers, "one", 30, Type::UINT);
  const MapPtr both = arrays.build();
  Snapshot look;
  look.readings = {{0, State::good, std::vector<std::uint16_t>(20, 7)}, {1, State::good, {7}}};
  EXPECT_LT(table_lines(both->map(), look, Colour::no)[3].size(), 60U);
}

TEST_F(DumpText, At_first_every_point_is_news) {
  const std::string time = std::string(noon_text) + " ";
  EXPECT_THAT(change_lines(map(), nullptr, now),
              ElementsAre(time + "lamp true", time + "horn write-only", time + "level 21.5 °C"));
}

TEST_F(DumpText, Later_only_what_has_changed_is_news) {
  Snapshot later = now;
  mark_changes(now, later);
  EXPECT_THAT(change_lines(map(), &now, later), IsEmpty());
  later.readings[2].registers = {44};
  mark_changes(now, later);
  EXPECT_THAT(change_lines(map(), &now, later), ElementsAre(HasSubstr(" level 22 °C")));
  later.readings[2] = {2, State::failed, {}, "exception 04 (server device failure)"};
  mark_changes(now, later);
  EXPECT_THAT(change_lines(map(), &now, later),
              ElementsAre(HasSubstr(" level not read: exception 04 (server device failure)")));
}

TEST_F(DumpText, Offline_is_told_once_and_what_comes_back_is_told_anew) {
  Snapshot away;
  away.at = noon;
  away.error = host::NotConnected{"refused"};
  EXPECT_THAT(change_lines(map(), &now, away), ElementsAre(std::string(noon_text) + " offline: refused"));
  EXPECT_THAT(change_lines(map(), &away, away), IsEmpty());
  EXPECT_THAT(change_lines(map(), &away, now),
              ElementsAre(HasSubstr(" online again"), HasSubstr(" lamp true"), HasSubstr(" horn "),
                          HasSubstr(" level 21.5 °C")));
}

TEST(Screen, A_frame_begins_at_the_top_and_leaves_nothing_of_the_one_before) {
  EXPECT_EQ(frame({"a", "bb"}, 24), "\033[Ha\033[K\nbb\033[K\n\033[J");
}

TEST(Screen, Lines_that_fit_are_all_shown) {
  EXPECT_EQ(frame({"a", "b"}, 3).find("more"), std::string::npos);
}

TEST(Screen, Of_too_many_lines_the_last_row_says_how_many_there_are) {
  EXPECT_EQ(frame({"a", "b", "c", "d"}, 4),
            "\033[Ha\033[K\nb\033[K\n… and 2 lines more; choose points with --points\033[K\n\033[J");
}

}  // namespace
}  // namespace coupler::tools
