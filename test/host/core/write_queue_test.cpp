// SPDX-License-Identifier: Apache-2.0
#include "host/core/write_queue.hpp"

#include <gtest/gtest.h>

#include <thread>

namespace coupler::driver {
namespace {

Write write_of(std::uint32_t point) {
  Write write;
  write.point = point;
  return write;
}

TEST(WriteQueue, Writes_come_out_in_the_order_they_went_in) {
  WriteQueue queue;
  for (std::uint32_t i = 0; i < 3; ++i) EXPECT_TRUE(queue.push(write_of(i)));
  for (std::uint32_t i = 0; i < 3; ++i) EXPECT_EQ(queue.take()->point, i);
  EXPECT_FALSE(queue.take());
}

TEST(WriteQueue, A_full_queue_takes_no_more) {
  WriteQueue queue;
  for (std::uint32_t i = 0; i < WriteQueue::capacity; ++i) ASSERT_TRUE(queue.push(write_of(i)));
  EXPECT_FALSE(queue.push(write_of(0)));
  queue.take();
  EXPECT_TRUE(queue.push(write_of(0)));
}

TEST(WriteQueue, A_write_wakes_the_one_who_waits) {
  WriteQueue queue;
  std::thread writer([&] { queue.push(write_of(5)); });
  queue.wait_until(Time::max());
  EXPECT_EQ(queue.take()->point, 5U);
  writer.join();
}

TEST(WriteQueue, Stopping_wakes_the_one_who_waits) {
  WriteQueue queue;
  std::thread stopper([&] { queue.stop(); });
  queue.wait_until(Time::max());
  stopper.join();
  queue.wait_until(Time::max());
  EXPECT_FALSE(queue.take());
}

}  // namespace
}  // namespace coupler::driver
