// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/ros/value_waiter.hpp"

#include <gtest/gtest.h>

#include <thread>

namespace coupler::host {
namespace {

constexpr std::uint32_t point = 3;

Time now() { return std::chrono::steady_clock::now(); }
Time far_away() { return now() + std::chrono::minutes(10); }

/// Calls `then` in another thread as soon as somebody waits.
template <class Then>
std::thread once_wanted(const ValueWaiter& next, Then then) {
  return std::thread([&next, then] {
    while (!next.is_wanted(point)) std::this_thread::yield();
    then();
  });
}

TEST(ValueWaiter, Nobody_waits_for_a_device_that_is_offline) {
  ValueWaiter next;
  EXPECT_FALSE(next.wait(point, far_away()));
  next.online(true);
  next.online(false);
  EXPECT_FALSE(next.wait(point, far_away()));
}

TEST(ValueWaiter, The_wait_ends_when_the_device_goes_offline) {
  ValueWaiter next;
  next.online(true);
  std::thread device = once_wanted(next, [&] { next.online(false); });
  EXPECT_FALSE(next.wait(point, far_away()));
  device.join();
}

TEST(ValueWaiter, A_value_that_comes_while_the_device_is_online_is_given) {
  ValueWaiter next;
  next.online(true);
  const std::uint16_t value = 7;
  std::thread device = once_wanted(next, [&] { next.bring(&value, 1, now()); });
  EXPECT_EQ(next.wait(point, far_away()), std::vector<std::uint16_t>{7});
  device.join();
}

TEST(ValueWaiter, A_value_that_was_asked_for_before_is_not_the_next_one) {
  ValueWaiter next;
  next.online(true);
  const std::uint16_t old = 7;
  const std::uint16_t value = 8;
  const Time before = now();
  std::thread device = once_wanted(next, [&] {
    next.bring(&old, 1, before);
    next.bring(&value, 1, now());
  });
  EXPECT_EQ(next.wait(point, far_away()), std::vector<std::uint16_t>{8});
  device.join();
}

}  // namespace
}  // namespace coupler::host
