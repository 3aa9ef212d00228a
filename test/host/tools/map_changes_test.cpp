// SPDX-License-Identifier: Apache-2.0
#include "coupler/tools/map_changes.hpp"

#include <gmock/gmock.h>

#include "coupler/map/loader/load.hpp"

namespace coupler::tools {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr auto cell = R"(
name: cell
rate: 10
mapping:
  coils:
    lamp: {address: 0, line: GPIO27, safe: off}
  holding_registers:
    speed: {address: 4, type: INT, units: rpm, initial: 5}
    label: {address: 10, type: STRING, length: 8}
)";

std::string replaced(std::string text, std::string_view from, std::string_view to) {
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

/// "breaking type-changed speed: INT -> UINT" for each change.
std::vector<std::string> changes_between(const std::string& old_text, const std::string& new_text) {
  const MapPtr older = load_map(old_text, "old.yaml").map;
  const LoadResult newer = load_map(new_text, "new.yaml");
  EXPECT_TRUE(newer.map) << new_text;
  if (!older || !newer.map) return {"does not load"};
  std::vector<std::string> lines;
  for (const Change& change : compare(older->map(), newer.map->map()))
    lines.push_back(std::string(to_string(change.severity)) + " " + change.rule + " " + change.point + ": " +
                    change.older + " -> " + change.newer);
  return lines;
}

/// The changes of cell.
std::vector<std::string> changes_by(std::string_view from, std::string_view to) {
  return changes_between(cell, replaced(cell, from, to));
}

TEST(Changes, A_comment_is_none) { EXPECT_THAT(changes_by("rate: 10", "rate: 10  # Hz"), IsEmpty()); }

TEST(Changes, What_the_wire_shows_is_breaking) {
  EXPECT_THAT(changes_by("address: 4", "address: 5"), ElementsAre("breaking address-moved speed: 4 -> 5"));
  EXPECT_THAT(changes_by("type: INT", "type: UINT"), ElementsAre("breaking type-changed speed: INT -> UINT"));
  EXPECT_THAT(changes_by("length: 8", "length: 9"), ElementsAre("breaking length-changed label: 8 -> 9"));
  EXPECT_THAT(changes_by("units: rpm", "units: rpm, access: write"),
              ElementsAre("breaking access-changed speed: read_write -> write"));
  EXPECT_THAT(changes_by("units: rpm", "units: rpm, scale: 0.5"),
              ::testing::Contains("breaking scale-changed speed: none -> 0.5"));
}

TEST(Changes, Each_changed_field_is_a_change) {
  EXPECT_THAT(
      changes_by("address: 4, type: INT", "address: 5, type: UINT"),
      ElementsAre("breaking address-moved speed: 4 -> 5", "breaking type-changed speed: INT -> UINT"));
}

TEST(Changes, A_point_of_another_name_in_the_same_place_is_renamed_otherwise_removed_and_added) {
  EXPECT_THAT(changes_by("label:", "title:"), ElementsAre("breaking point-renamed label: label -> title"));
  EXPECT_THAT(changes_by("label: {address: 10", "title: {address: 11"),
              ElementsAre("breaking point-removed label: holding_registers 10, STRING -> ",
                          "compatible point-added title:  -> holding_registers 11, STRING"));
}

TEST(Changes, What_changes_with_a_name_is_a_change_of_that_point) {
  EXPECT_THAT(
      changes_by("speed: {address: 4, type: INT, units: rpm",
                 "pace: {address: 4, type: INT, units: Hz, scale: 0.5"),
      ElementsAre("breaking point-renamed speed: speed -> pace", "breaking scale-changed speed: none -> 0.5",
                  "meaning units-changed speed: rpm -> Hz", "compatible initial-changed speed: [5] -> [10]"));
}

TEST(Changes, Points_that_change_places_are_not_renamed) {
  EXPECT_THAT(changes_by("lamp: {address: 0, line: GPIO27, safe: off}", "lamp: 1\n    horn: 0"),
              ::testing::Contains("breaking address-moved lamp: 0 -> 1"));
}

TEST(Changes, What_a_side_does_by_itself_is_compatible) {
  EXPECT_THAT(changes_by("initial: 5", "initial: 6"),
              ElementsAre("compatible initial-changed speed: [5] -> [6]"));
  EXPECT_THAT(changes_by("GPIO27", "GPIO17"), ElementsAre("compatible line-changed lamp: GPIO27 -> GPIO17"));
  EXPECT_THAT(changes_by("safe: off", "safe: hold"),
              ElementsAre("compatible safe-changed lamp: off -> hold"));
  EXPECT_THAT(changes_by("rate: 10", "rate: 20"),
              ElementsAre("compatible map-rate-changed : 10 Hz -> 20 Hz"));
  EXPECT_THAT(changes_by("rate: 10", "rate: 10\npoll: subscribed"),
              ElementsAre("compatible poll-changed : all -> subscribed"));
  EXPECT_THAT(changes_by("rate: 10", "rate: 10\nchanges: off"),
              ElementsAre("compatible changes-changed : true -> false"));
  EXPECT_THAT(changes_by("rate: 10", "rate: 10\nwait_for: true"),
              ElementsAre("compatible wait-for-changed : false -> true"));
  EXPECT_THAT(changes_by("units: rpm", "units: rpm, rate: 2"),
              ElementsAre("compatible rate-changed speed:  -> 2 Hz"));
  EXPECT_THAT(changes_by("units: rpm", "units: rpm, stamped: true"),
              ElementsAre("compatible stamped-changed speed: false -> true"));
}

TEST(Changes, Keys_that_are_told_as_one_change_are_named_with_their_values) {
  EXPECT_THAT(changes_by("rate: 10", "rate: 10\nlimits: {read_bits: 8, request_gap: 5ms}"),
              ElementsAre("compatible limits-changed : read_bits 2000, request_gap none -> read_bits 8, "
                          "request_gap 5ms"));
  EXPECT_THAT(changes_by("units: rpm", "units: rpm, publish: on_change, deadband: 2"),
              ElementsAre("compatible publish-changed speed: always, deadband 0 -> on_change, deadband 2"));
  EXPECT_THAT(changes_by("units: rpm", "units: rpm, max: 9"),
              ElementsAre("compatible bounds-changed speed: max none -> max 9"));
}

TEST(Changes, What_makes_a_value_mean_something_else_is_of_meaning) {
  EXPECT_THAT(changes_by("units: rpm", "units: Hz"), ElementsAre("meaning units-changed speed: rpm -> Hz"));
  EXPECT_THAT(changes_by("GPIO27", "GPIO27, active_low: true"),
              ElementsAre("meaning active-low-changed lamp: false -> true"));
  EXPECT_THAT(changes_by("GPIO27", "GPIO27, pulse: 1s"),
              ElementsAre("meaning pulse-changed lamp:  -> 1000ms"));
  EXPECT_THAT(changes_by("units: rpm", "units: rpm, values: {5: five}"),
              ElementsAre("meaning values-changed speed:  -> 5: five"));
}

TEST(Changes, Tools_are_told_by_their_names) {
  const std::string lift =
      replaced(cell, "rate: 10", "rate: 10\ntools: {lift: {close: lamp, travel: 300ms}}");
  EXPECT_THAT(changes_between(cell, lift),
              ElementsAre("compatible tool-added lift:  -> close lamp, travel 300ms"));
  EXPECT_THAT(changes_between(lift, cell),
              ElementsAre("compatible tool-removed lift: close lamp, travel 300ms -> "));
  EXPECT_THAT(changes_between(lift, replaced(lift, "lift:", "hoist:")),
              ElementsAre("compatible tool-removed lift: close lamp, travel 300ms -> ",
                          "compatible tool-added hoist:  -> close lamp, travel 300ms"));
  EXPECT_THAT(changes_between(lift, replaced(lift, "close: lamp, travel: 300ms", "open: lamp, travel: 1s")),
              ElementsAre("compatible tool-changed lift: close lamp, open none, travel 300ms -> "
                          "close none, open lamp, travel 1000ms"));
  EXPECT_THAT(
      changes_between(lift,
                      replaced(lift, "300ms", "300ms, joint: z, positions: {open: 0.4}, on_cancel: open")),
      ElementsAre(
          "compatible tool-changed lift: joint none, positions {open: 1, closed: 0}, on_cancel stay -> "
          "joint z, positions {open: 0.4, closed: 0}, on_cancel open"));
  EXPECT_THAT(changes_by("rate: 10", "rate: 10\njoint_rate: 25"),
              ElementsAre("compatible joint-rate-changed : 10 Hz -> 25 Hz"));
}

TEST(Changes, Axes_are_told_by_their_names) {
  const std::string glue = replaced(cell, "rate: 10", "rate: 10\naxes: {glue: {point: lamp}}");
  EXPECT_THAT(changes_between(cell, glue),
              ElementsAre("compatible axis-added glue:  -> point lamp, positions {0: 0, 1: 1}"));
  EXPECT_THAT(changes_between(glue, cell),
              ElementsAre("compatible axis-removed glue: point lamp, positions {0: 0, 1: 1} -> "));
  EXPECT_THAT(changes_between(glue, replaced(glue, "lamp}", "lamp, joint: z, positions: {on: 0, off: 1}}")),
              ElementsAre("compatible axis-changed glue: joint none, positions {0: 0, 1: 1} -> "
                          "joint z, positions {1: 0, 0: 1}"));
  EXPECT_THAT(changes_between(glue, replaced(glue, "lamp}", "speed}")),
              ElementsAre("compatible axis-changed glue: point lamp, positions {0: 0, 1: 1} -> "
                          "point speed, positions none"));
}

TEST(Changes, How_the_host_writes_a_point_is_compatible) {
  EXPECT_THAT(changes_by("units: rpm", "units: rpm, priority: high"),
              ElementsAre("compatible write-changed speed: priority normal -> priority high"));
}

TEST(Changes, What_only_people_read_is_documentation) {
  EXPECT_THAT(changes_by("units: rpm", "units: rpm, description: of the belt"),
              ElementsAre("documentation description-changed speed:  -> of the belt"));
}

TEST(Changes, An_initial_value_of_zero_is_none) {
  EXPECT_THAT(changes_by("length: 8", "length: 8, initial: ''"), IsEmpty());
}

}  // namespace
}  // namespace coupler::tools
