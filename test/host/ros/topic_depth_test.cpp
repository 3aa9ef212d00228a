// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/ros/topic_depth.hpp"

#include <gtest/gtest.h>

namespace coupler::host {
namespace {

Point point_of(Table table) {
  Point made;
  made.table = table;
  return made;
}

TEST(TopicDepth, Registers_which_come_one_by_one_have_ten) {
  EXPECT_EQ(topic_depth(point_of(Table::holding_registers)), 10U);
  EXPECT_EQ(topic_depth(point_of(Table::input_registers)), 10U);
}

TEST(TopicDepth, A_bit_has_more_than_one_reply_tells) {
  EXPECT_GT(topic_depth(point_of(Table::coils)), 18U);
  EXPECT_GT(topic_depth(point_of(Table::discrete_inputs)), 18U);
}

TEST(TopicDepth, What_the_map_says_holds_unless_it_is_ten) {
  Point bit = point_of(Table::coils);
  for (const std::uint32_t said : {1U, 5U, 50U}) {
    bit.host.queue_size = said;
    EXPECT_EQ(topic_depth(bit), said);
  }
}

}  // namespace
}  // namespace coupler::host
