// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/replay/player.hpp"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace coupler::device
