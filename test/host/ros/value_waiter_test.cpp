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
std::thread once_waited_for(const ValueWaiter& waiter, Then then) {
  return std::thread([&waiter, then] {
    while (!waiter.waits_for(point)) std::this_thread::yield();
    then();
  });
}

TEST(ValueWaiter, Nobody_waits_for_a_device_that_is_offline) {
  ValueWaiter waiter;
  EXPECT_FALSE(waiter.wait(point, far_away()));
  waiter.set_online(true);
  waiter.set_online(false);
  EXPECT_FALSE(waiter.wait(point, far_away()));
}

TEST(ValueWaiter, The_wait_ends_when_the_device_goes_offline) {
  ValueWaiter waiter;
  waiter.set_online(true);
  std::thread device = once_waited_for(waiter, [&] { waiter.set_online(false); });
  EXPECT_FALSE(waiter.wait(point, far_away()));
  device.join();
}

TEST(ValueWaiter, A_value_that_comes_while_the_device_is_online_is_given) {
  ValueWaiter waiter;
  waiter.set_online(true);
  const std::uint16_t value = 7;
  std::thread device = once_waited_for(waiter, [&] { waiter.deliver(&value, 1, now()); });
  EXPECT_EQ(waiter.wait(point, far_away()), std::vector<std::uint16_t>{7});
  device.join();
}

TEST(ValueWaiter, A_value_that_was_asked_for_before_is_not_the_next_one) {
  ValueWaiter waiter;
  waiter.set_online(true);
  const std::uint16_t old = 7;
  const std::uint16_t value = 8;
  const Time before = now();
  std::thread device = once_waited_for(waiter, [&] {
    waiter.deliver(&old, 1, before);
    waiter.deliver(&value, 1, now());
  });
  EXPECT_EQ(waiter.wait(point, far_away()), std::vector<std::uint16_t>{8});
  device.join();
}

}  // namespace
}  // namespace coupler::host
