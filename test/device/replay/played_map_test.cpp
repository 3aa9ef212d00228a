// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/replay/played_map.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "test/device/replay/recording_text.hpp"

namespace coupler::device {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

const std::string wired_map =
    "name: press\n"
    "mapping:\n"
    "  coils:\n"
    "    lamp: {address: 0, line: {chip: gpiochip0, offset: 4}, pulse: 100ms}\n"
    "    valve: {address: 1, initial: true}\n"
    "  discrete_inputs:\n"
    "    door: {address: 0, line: {chip: gpiochip0, offset: 5}}\n"
    "  holding_registers:\n"
    "    flag: {address: 0, type: BOOL, bit: 0}\n"
    "    alarm: {address: 0, type: BOOL, bit: 1}\n"
    "    level: {address: 1, type: INT, initial: 3}\n";

Recording own_recording(const std::string& map, const std::string& lines = {}) {
  return recording_of_lines(lines, map_of_text(map), played_head(map));
}

std::vector<std::uint16_t> initial_of(const PlayedMap& played, std::string_view name) {
  const Span<const std::uint16_t> initial = find(played.map, name)->initial;
  return {initial.begin(), initial.end()};
}

Recording wired_recording(const std::string& lines) {
  return recording_of_lines(lines, map_of_text(wired_map), played_head(wired_map));
}

TEST(MapToPlay, Has_no_hardware_left) {
  const Recording recording = wired_recording("");
  const PlayedMap played = map_to_play(recording);
  for (const Point& point : played.map.points) {
    EXPECT_FALSE(has_hardware(point)) << point.name;
    EXPECT_FALSE(is_pulsed(point)) << point.name;
  }
  EXPECT_TRUE(has_hardware(*find(recording.map()->map(), "lamp"))) << "the map of the recording is as it was";
}

TEST(MapToPlay, Begins_with_the_first_recorded_values) {
  const Recording recording =
      wired_recording(bit_at(0, "lamp", true) + bit_at(0, "valve", false) + words_at(0, "alarm", {2}) +
                      bit_at(1, "lamp", false) + words_at(2, "level", {0xFFFB}));
  const PlayedMap played = map_to_play(recording);
  EXPECT_THAT(initial_of(played, "lamp"), ElementsAre(1));
  EXPECT_THAT(initial_of(played, "valve"), ElementsAre(0));
  EXPECT_THAT(initial_of(played, "alarm"), ElementsAre(2));
  EXPECT_THAT(initial_of(played, "level"), ElementsAre(0xFFFB)) << "though it comes late";
}

TEST(MapToPlay, What_was_not_recorded_begins_as_in_the_map) {
  const Recording recording = wired_recording(record::no_value_line(played_at(0), "level", "exception", 4));
  const PlayedMap played = map_to_play(recording);
  EXPECT_THAT(initial_of(played, "level"), ElementsAre(3));
  EXPECT_THAT(initial_of(played, "valve"), ElementsAre(1));
  EXPECT_THAT(initial_of(played, "door"), IsEmpty());
}

TEST(MapToPlay, Is_the_same_map_to_clients) {
  const Recording recording = wired_recording("");
  const PlayedMap played = map_to_play(recording);
  EXPECT_EQ(played.map.fingerprint, recording.map()->map().fingerprint);
  EXPECT_EQ(played.map.text, recording.map()->map().text);
  EXPECT_EQ(played.map.points.size(), 6U);
}

/// The point that a point of the recording's map is in the map that is served.
const Point& served(const PlayedMap& played, const Recording& recording, std::string_view name) {
  return played.map.points[played.index[played_index(recording, name)]];
}

/// nullptr: it reads back where it is written.
const Point* read_back(const PlayedMap& played, const Recording& recording, std::string_view name) {
  const auto mirror = played.mirror[played_index(recording, name)];
  return mirror ? &played.map.points[*mirror] : nullptr;
}

TEST(MapToPlay, Where_an_output_reads_back_there_is_a_point_that_is_read) {
  const Recording recording = own_recording(
      "name: press\n"
      "mapping:\n"
      "  holding_registers:\n"
      "    plain: {address: 3, type: INT}\n"
      "    level: {address: 5, type: INT, read_address: 1}\n",
      words_at(0, "level", {7}));
  const PlayedMap played = map_to_play(recording);
  EXPECT_EQ(served(played, recording, "level").address, 5);
  EXPECT_EQ(served(played, recording, "level").read_address, std::nullopt);
  EXPECT_EQ(served(played, recording, "plain").name, "plain");
  EXPECT_EQ(read_back(played, recording, "plain"), nullptr);
  const Point* const mirror = read_back(played, recording, "level");
  ASSERT_NE(mirror, nullptr);
  EXPECT_EQ(mirror->address, 1);
  EXPECT_FALSE(is_writable(*mirror));
  EXPECT_THAT(initial_of(played, mirror->name), ElementsAre(7));
  EXPECT_EQ(played.map.fingerprint, recording.map()->map().fingerprint);
}

TEST(MapToPlay, Where_another_point_is_read_already_there_is_no_second_one) {
  const Recording recording = own_recording(
      "name: press\n"
      "mapping:\n"
      "  holding_registers:\n"
      "    actual: {address: 1, type: INT, access: read}\n"
      "    level: {address: 5, type: INT, read_address: 1}\n");
  const PlayedMap played = map_to_play(recording);
  EXPECT_EQ(read_back(played, recording, "level"), nullptr);
  EXPECT_EQ(played.map.points.size(), 2U);
}

TEST(MapToPlay, A_point_that_is_added_has_a_name_of_its_own) {
  const Recording recording = own_recording(
      "name: press\n"
      "mapping:\n"
      "  holding_registers:\n"
      "    level_reads_back: {address: 0, type: INT}\n"
      "    level: {address: 5, type: INT, read_address: 1}\n");
  const PlayedMap played = map_to_play(recording);
  EXPECT_EQ(find(played.map, "level_reads_back")->address, 0);
  ASSERT_NE(read_back(played, recording, "level"), nullptr);
  EXPECT_EQ(read_back(played, recording, "level")->name, "level_reads_back_");
}

}  // namespace
}  // namespace coupler::device
