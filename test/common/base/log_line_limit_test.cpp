// SPDX-License-Identifier: Apache-2.0
#include "coupler/base/log_line_limit.hpp"

#include <gtest/gtest.h>

namespace coupler {
namespace {

using std::chrono::milliseconds;
using Line = std::optional<std::string>;

TEST(LogLineLimit, A_flood_is_one_line_a_second_the_newest_with_a_count) {
  LogLineLimit limit;
  const LogLineLimit::Time begin{};
  EXPECT_EQ(limit.say("0", begin), Line("0"));
  for (int i = 1; i < 10; ++i) EXPECT_EQ(limit.say(std::to_string(i), begin + milliseconds(100 * i)), Line());
  EXPECT_EQ(limit.say("10", begin + milliseconds(1000)), Line("10 (and 9 more of this kind)"));
}

TEST(LogLineLimit, What_was_held_back_is_said_when_the_second_is_over) {
  LogLineLimit limit;
  const LogLineLimit::Time begin{};
  EXPECT_EQ(limit.due(begin), Line());
  limit.say("first", begin);
  limit.say("second", begin);
  EXPECT_EQ(limit.due_at(), begin + milliseconds(1000));
  EXPECT_EQ(limit.due(begin + milliseconds(999)), Line());
  EXPECT_EQ(limit.due(begin + milliseconds(1000)), Line("second"));
  EXPECT_EQ(limit.due(begin + milliseconds(9000)), Line());
  EXPECT_EQ(limit.due_at(), std::nullopt);
}

}  // namespace
}  // namespace coupler
