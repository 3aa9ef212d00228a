// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/replay/player.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "coupler/device/core/changes.hpp"
#include "coupler/device/core/image.hpp"
#include "coupler/map/image_layout.hpp"
#include "test/device/replay/recording_text.hpp"

namespace coupler::device {
namespace {

/// A player whose thread does not run: nothing is played yet.
TEST(Player, Answers_and_refuses_nothing_before_it_plays) {
  const Recording recording =
      recording_of_lines(record::lost_line(played_at(0), "timeout") +
                         record::no_value_line(played_at(0), "level", "exception", 4));
  const PlayedMap played = map_to_play(recording);
  ReplayOptions options;
  options.compared.assign(recording.map()->map().points.size(), true);
  Player player(recording, played, options);
  EXPECT_TRUE(player.answers());
  EXPECT_EQ(player.refuse_read(Table::holding_registers, modbus::Range::of(0, 2)), std::nullopt);
  EXPECT_EQ(player.differences(), 0U);
}

/// Level is 0, has an exception, is 1, has an exception, is 2, and so on.
std::string levels_with_exceptions(std::uint16_t last) {
  std::string lines = words_at(0, "level", {0});
  for (std::uint16_t level = 1; level <= last; ++level)
    lines += record::no_value_line(played_at(2 * level - 1), "level", "exception", 4) +
             words_at(2 * level, "level", {level});
  return lines;
}

TEST(Player, No_value_from_before_an_exception_is_read_after_it) {
  constexpr std::uint16_t last = 2000;
  const Recording recording = recording_of_lines(levels_with_exceptions(last));
  const PlayedMap played = map_to_play(recording);
  const NodeMemory size = node_memory(played.map);
  std::vector<Image::Area> areas(size.areas);
  std::vector<std::uint16_t> cells(size.cells);
  Image image(played.map, areas, cells);
  Changes changes;
  ReplayOptions options;
  options.speed = 4 * last;  // all of it in a second
  options.compared.assign(recording.map()->map().points.size(), false);
  Player player(recording, played, options);
  player.serving_began();
  constexpr auto level = modbus::Range::of(0, 1);
  std::vector<std::uint16_t> too_old;
  std::uint16_t next = 0;  // what may be read
  for (std::uint16_t now = 0; now != last && player.answers();) {
    player.put_new_values(image, changes);
    now = image.find(Table::holding_registers, level)[0];
    if (player.refuse_read(Table::holding_registers, level))
      next = static_cast<std::uint16_t>(now + 1);
    else if (now < next)
      too_old.push_back(now);
  }
  EXPECT_THAT(too_old, testing::IsEmpty());
}

}  // namespace
}  // namespace coupler::device
