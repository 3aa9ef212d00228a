// SPDX-License-Identifier: Apache-2.0
#include "host/core/write_queue.hpp"

#include <gmock/gmock.h>

#include "test/fakes/map_builder.hpp"

namespace coupler::driver {
namespace {

using codec::Type;
using testing::ElementsAre;

struct WriteQueueTest : testing::Test {
  static MapPtr build() {
    fakes::MapBuilder builder;
    builder.many(Table::coils, 0, 10);
    builder.add(Table::holding_registers, "every", 0, Type::UINT,
                [](Point& point) { point.host.write_queue = HostOptions::WriteQueue::every; });
    return builder.build();
  }
  static Write write_of(std::uint32_t point, std::uint16_t value = 0) {
    Write write;
    write.point = point;
    write.registers[0] = value;
    return write;
  }
  std::vector<std::uint32_t> take() {
    WriteBatch batch(owned->map());
    queue.take(batch);
    std::vector<std::uint32_t> points;
    for (const Write& write : batch.writes()) points.push_back(write.point);
    return points;
  }
  MapPtr owned = build();
  static constexpr std::uint32_t every = 10;
  WriteQueue queue{owned->map()};
};

TEST_F(WriteQueueTest, Writes_come_out_in_the_order_they_went_in) {
  for (const std::uint32_t point : {3U, 1U, 5U}) EXPECT_TRUE(queue.push(write_of(point)).accepted);
  for (const std::uint32_t point : {3U, 1U, 5U}) EXPECT_EQ(queue.take()->point, point);
  EXPECT_FALSE(queue.take());
  EXPECT_TRUE(queue.empty());
}

TEST_F(WriteQueueTest, Order_is_kept_while_it_grows_and_wraps) {
  std::uint16_t in = 0;
  std::uint16_t out = 0;
  for (int round = 0; round < 40; ++round) {
    for (int i = 0; i < 7; ++i, ++in) queue.push(write_of(in % 2U, in));
    for (int i = 0; i < 5; ++i, ++out) ASSERT_EQ(queue.take()->registers[0], out);
  }
}

TEST_F(WriteQueueTest, A_full_queue_takes_no_more) {
  for (std::uint32_t i = 0; i < WriteQueue::capacity; ++i) ASSERT_TRUE(queue.push(write_of(i % 2)).accepted);
  EXPECT_FALSE(queue.push(write_of(5)).accepted);
  queue.take();
  EXPECT_TRUE(queue.push(write_of(5)).accepted);
}

TEST_F(WriteQueueTest, A_newer_value_replaces_the_last_one_of_the_same_point) {
  queue.push(write_of(1, 7));
  const auto pushed = queue.push(write_of(1, 8));
  ASSERT_TRUE(pushed.superseded);
  EXPECT_EQ(pushed.superseded->registers[0], 7);
  EXPECT_EQ(queue.take()->registers[0], 8);
  EXPECT_TRUE(queue.empty());
}

TEST_F(WriteQueueTest, A_value_behind_which_another_point_waits_is_not_replaced) {
  queue.push(write_of(1, 1));
  queue.push(write_of(5, 1));
  EXPECT_FALSE(queue.push(write_of(1, 0)).superseded);
}

TEST_F(WriteQueueTest, Every_value_is_kept_where_the_map_asks_for_it) {
  queue.push(write_of(every, 1));
  EXPECT_FALSE(queue.push(write_of(every, 2)).superseded);
}

TEST_F(WriteQueueTest, A_write_that_goes_alone_neither_replaces_nor_is_replaced) {
  Write service = write_of(1, 5);
  service.alone = true;
  queue.push(write_of(1, 1));
  EXPECT_FALSE(queue.push(service).superseded);
  EXPECT_FALSE(queue.push(write_of(1, 2)).superseded);
}

TEST_F(WriteQueueTest, Neighbours_in_the_queue_and_in_the_device_are_taken_together) {
  for (const std::uint32_t point : {4U, 5U, 3U, 9U, 8U, 1U}) queue.push(write_of(point));
  EXPECT_THAT(take(), ElementsAre(4, 5, 3));
  EXPECT_THAT(take(), ElementsAre(9, 8));
  EXPECT_THAT(take(), ElementsAre(1));
}

TEST_F(WriteQueueTest, A_point_that_comes_twice_is_not_in_one_request_twice) {
  for (const std::uint32_t point : {4U, 5U, 4U}) queue.push(write_of(point));
  EXPECT_THAT(take(), ElementsAre(4, 5));
  EXPECT_THAT(take(), ElementsAre(4));
}

TEST_F(WriteQueueTest, A_value_is_on_its_way_from_push_to_result) {
  EXPECT_FALSE(queue.any_pending());
  queue.push(write_of(1, 1));
  queue.push(write_of(1, 2));
  EXPECT_TRUE(queue.is_pending(1));
  take();
  EXPECT_TRUE(queue.is_pending(1));
  queue.settled(1);
  EXPECT_FALSE(queue.is_pending(1));
  EXPECT_FALSE(queue.any_pending());
}

}  // namespace
}  // namespace coupler::driver
