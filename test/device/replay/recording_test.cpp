// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/replay/recording.hpp"

#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "test/device/replay/recording_text.hpp"

namespace coupler::device {
namespace {

using record::end_line;
using record::head_line;
using record::lost_line;
using record::no_value_line;
using record::online_line;
using std::chrono::milliseconds;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

/// The events, each as "ms: what".
std::vector<std::string> events_of(const Recording& recording) {
  using Kind = Recording::Event::Kind;
  std::vector<std::string> texts;
  for (const Recording::Event& event : recording.events()) {
    const Point& point = recording.map()->map().points[event.point];
    const std::uint16_t* const first = recording.registers(event);
    const std::string what =
        event.kind == Kind::lost     ? "lost"
        : event.kind == Kind::online ? "online"
        : event.kind == Kind::exception
            ? fmt::format("{}!{}", point.name, static_cast<int>(*event.exception))
            : fmt::format("{}={}", point.name, fmt::join(first, first + range(point).count(), ","));
    texts.push_back(fmt::format("{}: {}", std::chrono::duration_cast<milliseconds>(event.at).count(), what));
  }
  return texts;
}

std::string error_of(const std::string& text) {
  std::istringstream in(text);
  const auto recording = Recording::read(in, "press.jsonl", nullptr);
  return recording ? "" : recording.error();
}

TEST(Recording, Has_what_was_recorded_of_each_point) {
  const Recording recording = recording_of_lines(
      words_at(0, "level", {0xFFFB}) + bit_at(0.25, "lamp", true) +
      record::value_line(played_at(0.5), "row", "[false,true]", {}, {}) +
      words_at(0.75, "temperature", {0x4048, 0xF5C3}) + no_value_line(played_at(1), "level", "exception", 6) +
      words_at(1.25, "level", {7}) + end_line(played_at(2)));
  EXPECT_THAT(events_of(recording),
              ElementsAre("0: level=65531", "250: lamp=1", "500: row=0,1", "750: temperature=16456,62915",
                          "1000: level!6", "1250: level=7"));
  EXPECT_EQ(recording.length(), milliseconds(2000)) << "to its end, though nothing changes any more";
  EXPECT_THAT(recording.left_out(), IsEmpty());
}

TEST(Recording, Of_the_first_file_or_a_later_one_begins_at_0) {
  std::istringstream text(head_line(played_head(), played_at(100)) + words_at(100, "level", {5}) +
                          words_at(101.5, "level", {6}));
  const auto recording = Recording::read(text, "press.jsonl", nullptr);
  ASSERT_TRUE(recording);
  EXPECT_THAT(events_of(*recording), ElementsAre("0: level=5", "1500: level=6"));
  EXPECT_EQ(recording->length(), milliseconds(1500));
  EXPECT_EQ(recording->wall_at_begin(), played_at(0).wall);
}

TEST(Recording, Is_in_the_order_of_the_times_and_of_the_lines_where_they_are_equal) {
  EXPECT_THAT(events_of(recording_of_lines(words_at(2, "level", {1}) + words_at(1, "level", {2}) +
                                           words_at(2, "level", {3}) + words_at(1, "level", {4}))),
              ElementsAre("1000: level=2", "1000: level=4", "2000: level=1", "2000: level=3"));
}

TEST(Recording, What_was_before_its_beginning_is_at_its_beginning) {
  std::istringstream text(head_line(played_head(), played_at(100)) + words_at(99, "level", {5}));
  EXPECT_THAT(events_of(*Recording::read(text, "press.jsonl", nullptr)), ElementsAre("0: level=5"));
}

TEST(Recording, Knows_how_often_points_were_read) {
  const Recording recording = recording_of_lines("");
  EXPECT_EQ(recording.period(played_index(recording, "level")), milliseconds(100));
  EXPECT_EQ(recording.period(played_index(recording, "lamp")), milliseconds(20));
  EXPECT_EQ(recording.period(played_index(recording, "speed")), milliseconds(0)) << "it was not recorded";
}

TEST(Recording, Points_that_were_not_recorded_are_named_with_the_reason) {
  record::Head head = played_head();
  head.not_recorded = {{"speed", "write-only"}};
  EXPECT_THAT(recording_of_lines("", nullptr, head).left_out(),
              ElementsAre("'speed' is not in the recording: write-only"));
}

TEST(Recording, Of_another_map_points_that_it_has_not_or_that_mean_something_else_are_left_out_and_named) {
  const MapPtr other = map_of_text(
      "name: press\n"
      "mapping:\n"
      "  coils: {lamp: 100, row: {address: 8, count: 3}}\n"
      "  holding_registers:\n"
      "    level: {address: 7, type: UINT}\n"
      "    speed: {address: 1, type: INT}\n"
      "    more: {address: 2, type: INT}\n");
  const Recording recording = recording_of_lines(
      words_at(0, "level", {1}) + bit_at(0, "lamp", true) + words_at(0, "temperature", {1, 2}) +
          record::value_line(played_at(0), "row", "[true,true]", {}, {}) + words_at(0, "speed", {3}) +
          no_value_line(played_at(0), "level", "exception", 6) + words_at(0, "nobody", {1}),
      other);
  EXPECT_EQ(recording.map(), other);
  EXPECT_THAT(events_of(recording), ElementsAre("0: lamp=1", "0: speed=3"));
  EXPECT_THAT(recording.left_out(),
              testing::UnorderedElementsAre("'level' is not played: it has another type in the map",
                                            "'row' is not played: it has another type in the map",
                                            "'temperature' is not played: the map has no such point",
                                            "1 values are not played: of points that the recording's map "
                                            "does not have, or too short or long"));
  EXPECT_EQ(recording.period(played_index(recording, "lamp")), milliseconds(20));
  EXPECT_EQ(recording.period(played_index(recording, "level")), milliseconds(0));
}

TEST(Recording, A_value_with_too_few_or_too_many_registers_is_passed_over) {
  EXPECT_THAT(events_of(recording_of_lines(words_at(0, "level", {1, 2}) + words_at(0, "temperature", {1}) +
                                           bit_at(0, "row", true) + words_at(1, "level", {3}))),
              ElementsAre("1000: level=3"));
}

TEST(Recording, Silence_of_the_device_is_part_of_it) {
  EXPECT_THAT(
      events_of(recording_of_lines(online_line(played_at(0), true) + words_at(0, "level", {1}) +
                                   lost_line(played_at(2), "timeout") + online_line(played_at(3), true))),
      ElementsAre("0: online", "0: level=1", "2000: lost", "3000: online"));
}

TEST(Recording, The_device_was_foreign_if_a_line_says_so) {
  EXPECT_TRUE(recording_of_lines(online_line(played_at(0), false)).is_foreign());
  EXPECT_FALSE(recording_of_lines(online_line(played_at(0), true)).is_foreign());
  EXPECT_FALSE(recording_of_lines(online_line(played_at(0), std::nullopt)).is_foreign());
}

TEST(Recording, The_silence_before_the_first_connection_is_forgotten_if_it_is_short) {
  const std::string lost =
      lost_line(played_at(0), "not connected yet") + lost_line(played_at(0.25), "refused");
  EXPECT_THAT(
      events_of(recording_of_lines(lost + online_line(played_at(1), true) + words_at(1, "level", {1}) +
                                   lost_line(played_at(1.25), "timeout"))),
      ElementsAre("1000: online", "1000: level=1", "1250: lost"));
  EXPECT_THAT(events_of(recording_of_lines(lost + online_line(played_at(1.001), true))),
              ElementsAre("0: lost", "250: lost", "1001: online"));
  EXPECT_THAT(events_of(recording_of_lines(lost)), ElementsAre("0: lost", "250: lost"));
}

TEST(Recording, Of_what_is_cut_short_the_rest_is_played) {
  EXPECT_THAT(events_of(recording_of_lines(words_at(0, "level", {1}) + "{\"t\":0.5,\"utc\":\"20")),
              ElementsAre("0: level=1"));
}

TEST(Recording, A_line_that_is_wrong_names_the_file_and_the_line) {
  EXPECT_EQ(error_of(head_line(played_head(), played_at(0)) + "{}\n"), "press.jsonl:2: it has no 't'");
  EXPECT_THAT(error_of("name: press\n"), StartsWith("press.jsonl:1: this is no recording"));
}

TEST(Recording, A_map_in_it_that_does_not_load_says_why) {
  EXPECT_THAT(error_of(head_line(played_head("name: press\nmapping: {coils: {lamp: -1}}\n"), played_at(0))),
              testing::AllOf(StartsWith("press.jsonl: the map in it does not load: "), HasSubstr("-1")));
}

TEST(Recording, A_map_in_it_may_have_keys_of_a_newer_program) {
  EXPECT_EQ(
      error_of(head_line(played_head("name: press\nlater: 1\nmapping: {coils: {lamp: 0}}\n"), played_at(0))),
      "");
}

}  // namespace
}  // namespace coupler::device
