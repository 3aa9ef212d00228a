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

/// What a node has of a player in the process that serves.
struct Shown {
  explicit Shown(const Map& map) : size(node_memory(map)), image(map, areas, cells) {}

  NodeMemory size;
  std::vector<Image::Area> areas = std::vector<Image::Area>(size.areas);
  std::vector<std::uint16_t> cells = std::vector<std::uint16_t>(size.cells);
  Image image;
  Changes changes;
};

/// A player whose thread does not run: nothing is played yet.
TEST(Player, Answers_and_refuses_nothing_before_it_plays) {
  const Recording recording =
      recording_of_lines(record::lost_line(played_at(0), "timeout") +
                         record::no_value_line(played_at(0), "level", "exception", 4));
  const PlayedMap played = map_to_play(recording);
  ReplayOptions options;
  options.compared.assign(recording.map()->map().points.size(), true);
  Player player(recording, played, options);
  Shown node(played.map);
  player.put_new_values(node.image, node.changes);
  EXPECT_TRUE(player.answers());
  EXPECT_EQ(player.refuse_read(Table::holding_registers, modbus::Range::of(0, 2)), std::nullopt);
  EXPECT_EQ(player.differences(), 0U);
}

/// Level and speed are 0; level has an exception; both are 1; level has an exception; both are 2, and so on.
std::string values_with_exceptions(std::uint16_t last) {
  std::string lines = words_at(0, "level", {0}) + words_at(0, "speed", {0});
  for (std::uint16_t value = 1; value <= last; ++value)
    lines += record::no_value_line(played_at(2 * value - 1), "level", "exception", 4) +
             words_at(2 * value, "level", {value}) + words_at(2 * value, "speed", {value});
  return lines;
}

TEST(Player, What_has_the_same_time_is_so_at_once_also_the_end_of_an_exception) {
  constexpr std::uint16_t last = 2000;
  const Recording recording = recording_of_lines(values_with_exceptions(last));
  const PlayedMap played = map_to_play(recording);
  Shown node(played.map);
  ReplayOptions options;
  options.speed = 4 * last;  // all of it in half a second
  options.compared.assign(recording.map()->map().points.size(), false);
  Player player(recording, played, options);
  player.serving_began();
  constexpr auto both = modbus::Range::of(0, 2);
  std::vector<std::uint16_t> too_old, different;
  std::uint16_t next = 0;  // what may be read
  for (std::uint16_t now = 0; now != last && player.answers();) {
    player.put_new_values(node.image, node.changes);
    const auto values = node.image.find(Table::holding_registers, both);
    now = values[0];
    if (values[1] != now) different.push_back(now);
    if (player.refuse_read(Table::holding_registers, both))
      next = static_cast<std::uint16_t>(now + 1);
    else if (now < next)
      too_old.push_back(now);
  }
  EXPECT_THAT(too_old, testing::IsEmpty()) << "from before an exception, read after it";
  EXPECT_THAT(different, testing::IsEmpty());
}

}  // namespace
}  // namespace coupler::device
