// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/core/write_queue.hpp"

#include <gmock/gmock.h>

#include <string>

#include "test/fakes/map_builder.hpp"

namespace coupler::host {
namespace {

using codec::Type;
using testing::ElementsAre;

struct WriteQueueTest : testing::Test {
  static MapPtr build() {
    fakes::MapBuilder builder;
    builder.many(Table::coils, 0, 10);
    for (std::uint16_t i = 0; i < 10; ++i)
      builder.add(Table::holding_registers, "n" + std::to_string(i), i, Type::UINT);
    builder.add(Table::holding_registers, "every", 20, Type::UINT,
                [](Point& point) { point.host.write_queue = HostOptions::WriteQueue::every; });
    builder.add(Table::holding_registers, "flags", 21, Type::WORD);
    const auto first = [](Point& point) { point.host.priority = HostOptions::Priority::high; };
    for (std::uint16_t i = 0; i < 2; ++i) {
      const std::string index = std::to_string(i);
      builder.add(Table::coils, "high_coil" + index, static_cast<std::uint16_t>(10 + i), Type::BOOL, first);
      builder.add(Table::holding_registers, "high" + index, static_cast<std::uint16_t>(30 + i), Type::UINT,
                  first);
    }
    return builder.build();
  }
  static constexpr std::uint32_t high_coil = 10;  ///< the neighbour of coil 9
  static constexpr std::uint32_t other_high_coil = 11;
  static constexpr std::uint32_t number = 12;  ///< the first of ten
  static constexpr std::uint32_t every = 22;
  static constexpr std::uint32_t flags = 23;
  static constexpr std::uint32_t high_number = 24;
  static constexpr std::uint32_t other_high_number = 25;

  static Write write_of(std::uint32_t point, std::uint16_t value = 0) {
    Write write;
    write.point = point;
    write.registers[0] = value;
    return write;
  }
  static Write service_of(std::uint32_t point, std::uint16_t value) {
    Write write = write_of(point, value);
    write.ordered = true;
    return write;
  }
  /// The value that was superseded, -1 if none was.
  int push(const Write& write) {
    const auto pushed = queue.push(write);
    EXPECT_TRUE(pushed.accepted);
    return pushed.superseded ? pushed.superseded->registers[0] : -1;
  }
  int push(std::uint32_t point, std::uint16_t value) { return push(write_of(point, value)); }
  /// Points and values of the next request.
  std::vector<std::uint32_t> take() {
    WriteBatch batch(owned->map());
    queue.take(batch);
    std::vector<std::uint32_t> points;
    for (const Write& write : batch.writes()) points.push_back(write.point);
    return points;
  }
  using Value = std::pair<std::uint32_t, int>;
  /// All that wait, one by one.
  std::vector<Value> take_all() {
    std::vector<Value> values;
    while (const auto write = queue.take()) values.emplace_back(write->point, write->registers[0]);
    return values;
  }
  MapPtr owned = build();
  WriteQueue queue{owned->map()};
};

TEST_F(WriteQueueTest, Ordered_writes_come_out_in_the_order_they_went_in) {
  for (const std::uint32_t point : {3U, every, 5U, flags}) push(point, 1);
  EXPECT_THAT(take_all(), ElementsAre(Value(3, 1), Value(every, 1), Value(5, 1), Value(flags, 1)));
  EXPECT_TRUE(queue.empty());
}

TEST_F(WriteQueueTest, Order_is_kept_while_it_grows_and_shrinks) {
  std::uint16_t in = 0;
  std::uint16_t out = 0;
  for (int round = 0; round < 40; ++round) {
    for (int i = 0; i < 7; ++i, ++in) push(in % 2U, in);
    for (int i = 0; i < 5; ++i, ++out) ASSERT_EQ(queue.take()->registers[0], out);
  }
}

TEST_F(WriteQueueTest, A_full_queue_takes_no_more_ordered_writes_and_every_number) {
  for (std::uint32_t i = 0; i < WriteQueue::capacity; ++i)
    ASSERT_TRUE(queue.push(write_of(1, static_cast<std::uint16_t>(i))).accepted);
  EXPECT_FALSE(queue.push(write_of(5)).accepted);
  for (std::uint32_t i = 0; i < 10; ++i) push(number + i, 1);
  queue.take();
  EXPECT_TRUE(queue.push(write_of(5)).accepted);
  EXPECT_FALSE(queue.push(write_of(6)).accepted);
}

TEST_F(WriteQueueTest, A_number_has_one_place_that_its_newest_value_takes) {
  push(number, 1);
  push(number + 5, 7);
  EXPECT_EQ(push(number, 2), 1);
  EXPECT_EQ(push(number, 3), 2);
  EXPECT_THAT(take_all(), ElementsAre(Value(number, 3), Value(number + 5, 7)));
}

TEST_F(WriteQueueTest, A_number_does_not_overtake_an_ordered_write_made_before_it) {
  push(number, 1);
  push(3, 1);
  EXPECT_EQ(push(number, 2), 1);
  EXPECT_EQ(push(number, 3), 2);
  EXPECT_THAT(take_all(), ElementsAre(Value(3, 1), Value(number, 3)));
}

TEST_F(WriteQueueTest, Numbers_never_wait_at_more_places_than_there_are_points) {
  for (std::uint16_t i = 0; i < 100; ++i) {
    push(3, i);
    push(number, i);
    push(number + 1, i);
  }
  EXPECT_EQ(take_all().size(), 102U);
}

TEST_F(WriteQueueTest, A_value_that_waits_already_is_not_queued_again) {
  push(3, 1);
  push(4, 1);
  EXPECT_EQ(push(3, 1), 1);
  EXPECT_EQ(push(3, 0), -1);
  EXPECT_EQ(push(3, 1), -1) << "only the newest one counts: 0 goes between";
  EXPECT_THAT(take_all(), ElementsAre(Value(3, 1), Value(4, 1), Value(3, 0), Value(3, 1)));
}

TEST_F(WriteQueueTest, Every_value_is_kept_where_the_map_asks_for_it) {
  for (const int value : {1, 2, 2}) EXPECT_EQ(push(every, static_cast<std::uint16_t>(value)), -1);
  EXPECT_THAT(take_all(), ElementsAre(Value(every, 1), Value(every, 2), Value(every, 2)));
}

TEST_F(WriteQueueTest, A_service_neither_replaces_nor_is_replaced) {
  push(number, 1);
  EXPECT_EQ(push(service_of(number, 2)), -1);
  EXPECT_EQ(push(service_of(number, 2)), -1);
  EXPECT_EQ(push(number, 3), 1);
  EXPECT_EQ(push(number, 4), 3);
  EXPECT_THAT(take_all(), ElementsAre(Value(number, 2), Value(number, 2), Value(number, 4)));
}

TEST_F(WriteQueueTest, What_is_put_back_is_first_again_and_pending_all_the_while) {
  for (const std::uint32_t point : {3U, 4U, 9U}) push(point, 1);
  WriteBatch batch(owned->map());
  queue.take(batch);
  queue.put_back(batch.writes());
  EXPECT_THAT(take_all(), ElementsAre(Value(3, 1), Value(4, 1), Value(9, 1)));
  for (const std::uint32_t point : {3U, 4U, 9U}) queue.settled(point);
  EXPECT_FALSE(queue.any_pending());
}

TEST_F(WriteQueueTest, Writes_to_some_points_are_taken_out_wherever_they_stand) {
  std::uint16_t value = 0;
  for (const std::uint32_t point : {3U, number, 4U, 3U}) push(point, value++);
  std::vector<bool> some(owned->map().points.size());
  some[3] = some[number] = true;
  std::vector<std::uint32_t> taken;
  while (const auto write = queue.take_one_of(some)) taken.push_back(write->point);
  EXPECT_THAT(taken, ElementsAre(3, number, 3));
  EXPECT_THAT(take_all(), ElementsAre(Value(4, 2)));
}

TEST_F(WriteQueueTest, Neighbours_in_the_queue_and_in_the_device_are_taken_together) {
  for (const std::uint32_t point : {4U, 5U, 3U, 9U, 8U, 1U}) queue.push(write_of(point));
  EXPECT_THAT(take(), ElementsAre(4, 5, 3));
  EXPECT_THAT(take(), ElementsAre(9, 8));
  EXPECT_THAT(take(), ElementsAre(1));
}

TEST_F(WriteQueueTest, Writes_that_are_pushed_together_stay_together) {
  push(number, 1);
  push(3, 1);
  const std::vector<Write> writes{service_of(number, 2), service_of(number + 1, 2),
                                  service_of(number + 2, 2)};
  EXPECT_TRUE(queue.push_together(writes));
  push(number + 3, 3);
  EXPECT_THAT(take(), ElementsAre(number));
  EXPECT_THAT(take(), ElementsAre(3));
  EXPECT_THAT(take(), ElementsAre(number, number + 1, number + 2, number + 3));
}

TEST_F(WriteQueueTest, Writes_for_which_there_is_no_room_together_are_not_in_the_queue) {
  for (std::size_t i = 0; i < WriteQueue::capacity - 1; ++i) push(every, static_cast<std::uint16_t>(i));
  const std::vector<Write> writes{service_of(number, 2), service_of(number + 1, 2)};
  EXPECT_FALSE(queue.push_together(writes));
  EXPECT_FALSE(queue.is_pending(number));
  EXPECT_TRUE(queue.push_together({&writes[1], 1}));
}

TEST_F(WriteQueueTest, A_point_that_comes_twice_is_not_in_one_request_twice) {
  for (const std::uint32_t point : {4U, 5U}) push(point, 1);
  push(4, 0);
  EXPECT_THAT(take(), ElementsAre(4, 5));
  EXPECT_THAT(take(), ElementsAre(4));
}

TEST_F(WriteQueueTest, Writes_of_high_priority_go_before_all_others_that_wait) {
  push(3, 1);
  push(number, 1);
  push(service_of(number, 2));
  push(high_number, 1);
  push(high_coil, 1);
  EXPECT_THAT(take_all(), ElementsAre(Value(high_number, 1), Value(high_coil, 1), Value(3, 1),
                                      Value(number, 1), Value(number, 2)));
  EXPECT_TRUE(queue.empty());
}

TEST_F(WriteQueueTest, Order_stays_within_each_priority) {
  for (std::uint16_t i = 0; i < 3; ++i) {
    push(3, i);
    push(every, i);
    push(high_coil, i % 2U);
    push(service_of(high_number, i));
  }
  EXPECT_THAT(take_all(),
              ElementsAre(Value(high_coil, 0), Value(high_number, 0), Value(high_coil, 1),
                          Value(high_number, 1), Value(high_coil, 0), Value(high_number, 2), Value(3, 0),
                          Value(every, 0), Value(3, 1), Value(every, 1), Value(3, 2), Value(every, 2)));
}

TEST_F(WriteQueueTest, A_number_gives_way_to_ordered_writes_of_its_own_priority_only) {
  push(high_number, 1);
  push(other_high_number, 1);
  push(3, 1);
  EXPECT_EQ(push(high_number, 2), 1) << "a coil of normal priority waits behind it anyway";
  EXPECT_THAT(take_all(), ElementsAre(Value(high_number, 2), Value(other_high_number, 1), Value(3, 1)));
  push(number, 1);
  push(number + 1, 1);
  push(high_coil, 1);
  EXPECT_EQ(push(number, 2), 1);
  EXPECT_THAT(take_all(), ElementsAre(Value(high_coil, 1), Value(number, 2), Value(number + 1, 1)));
  push(high_number, 1);
  push(high_coil, 1);
  EXPECT_EQ(push(high_number, 2), 1);
  EXPECT_THAT(take_all(), ElementsAre(Value(high_coil, 1), Value(high_number, 2)));
}

TEST_F(WriteQueueTest, A_queue_that_is_full_takes_writes_of_the_other_priority) {
  for (std::uint32_t i = 0; i < WriteQueue::capacity; ++i) push(1, static_cast<std::uint16_t>(i));
  EXPECT_FALSE(queue.push(write_of(5)).accepted);
  for (std::uint32_t i = 0; i < WriteQueue::capacity; ++i) push(high_coil, static_cast<std::uint16_t>(i));
  EXPECT_FALSE(queue.push(write_of(other_high_coil)).accepted);
}

TEST_F(WriteQueueTest, A_request_holds_writes_of_one_priority) {
  for (const std::uint32_t point : {9U, 8U, high_coil, other_high_coil}) push(point, 1);
  EXPECT_THAT(take(), ElementsAre(high_coil, other_high_coil));
  EXPECT_THAT(take(), ElementsAre(9, 8));
}

TEST_F(WriteQueueTest, What_is_put_back_is_first_of_its_priority_and_behind_a_higher_one) {
  for (const std::uint32_t point : {3U, 4U, 9U}) push(point, 1);
  WriteBatch batch(owned->map());
  queue.take(batch);
  push(high_coil, 1);
  queue.put_back(batch.writes());
  EXPECT_THAT(take_all(), ElementsAre(Value(high_coil, 1), Value(3, 1), Value(4, 1), Value(9, 1)));
}

TEST_F(WriteQueueTest, Writes_to_some_points_are_taken_out_in_either_priority) {
  std::uint16_t value = 0;
  for (const std::uint32_t point : {3U, high_coil, high_number, 4U}) push(point, value++);
  std::vector<bool> some(owned->map().points.size());
  some[3] = some[high_number] = true;
  std::vector<std::uint32_t> taken;
  while (const auto write = queue.take_one_of(some)) taken.push_back(write->point);
  EXPECT_THAT(taken, ElementsAre(high_number, 3));
  EXPECT_THAT(take_all(), ElementsAre(Value(high_coil, 1), Value(4, 3)));
}

TEST_F(WriteQueueTest, A_value_is_on_its_way_from_push_to_result) {
  EXPECT_FALSE(queue.any_pending());
  push(number, 1);
  push(number, 2);
  push(3, 1);
  push(number, 3);
  EXPECT_TRUE(queue.is_pending(number));
  take();
  take();
  EXPECT_TRUE(queue.is_pending(number));
  queue.settled(number);
  EXPECT_FALSE(queue.is_pending(number));
  queue.settled(3);
  EXPECT_FALSE(queue.any_pending());
}

TEST_F(WriteQueueTest, A_write_that_a_newer_one_replaces_has_its_result_then) {
  push(number, 1);
  const std::uint32_t first = queue.queued(number);
  EXPECT_FALSE(queue.has_results(number, first));
  EXPECT_EQ(push(number, 2), 1) << "in its place";
  EXPECT_TRUE(queue.has_results(number, first));
  EXPECT_FALSE(queue.has_results(number, queue.queued(number)));
}

TEST_F(WriteQueueTest, What_has_waited_longer_than_it_may_is_taken_out) {
  const Time now = Time() + std::chrono::seconds(10);
  Write dated = service_of(number, 1);
  dated.until = now;
  push(dated);
  push(0, 1);
  dated.registers[0] = 2;
  dated.until = now + std::chrono::seconds(1);
  push(dated);
  EXPECT_FALSE(queue.take_late(now)) << "the moment itself is not too late";
  const auto late = queue.take_late(now + std::chrono::milliseconds(1));
  ASSERT_TRUE(late);
  EXPECT_EQ(late->registers[0], 1);
  EXPECT_FALSE(queue.take_late(now + std::chrono::milliseconds(1)));
  EXPECT_EQ(queue.take()->point, 0U) << "what has no limit stays where it was";
  EXPECT_EQ(queue.take()->registers[0], 2);
}

}  // namespace
}  // namespace coupler::host
