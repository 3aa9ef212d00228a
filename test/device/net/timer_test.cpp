// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/net/timer.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace coupler::device {
namespace {

using std::chrono::milliseconds;

class Timers : public testing::Test {
 protected:
  void run_until_called(std::size_t times) {
    while (called_.size() < times) loop_.run_once(std::chrono::seconds(60));
  }

  Loop loop_;
  std::vector<TimePoint> called_;
  Timer timer_{loop_, [this](TimePoint now) { called_.push_back(now); }};
};

TEST_F(Timers, It_calls_at_its_time_once_and_never_before) {
  const TimePoint at = TimePoint::clock::now() + milliseconds(20) + std::chrono::nanoseconds(1);
  timer_.set(at);
  run_until_called(1);
  EXPECT_GE(called_[0], at);
  loop_.run_once(milliseconds(0));
  EXPECT_EQ(called_.size(), 1U);
}

TEST_F(Timers, A_time_that_is_past_is_now) {
  timer_.set(TimePoint::clock::now() - std::chrono::hours(1));
  run_until_called(1);
  timer_.set(TimePoint{});
  run_until_called(2);
}

TEST_F(Timers, The_same_time_can_be_set_again_once_it_has_come) {
  const TimePoint at = TimePoint::clock::now();
  for (std::size_t times = 1; times <= 3; ++times) {
    timer_.set(at);
    run_until_called(times);
  }
}

TEST_F(Timers, Another_time_replaces_the_one_before_and_none_stops_it) {
  timer_.set(TimePoint::clock::now());
  timer_.set(TimePoint::max());
  const TimePoint at = TimePoint::clock::now() + milliseconds(20);
  loop_.run_once(milliseconds(1));
  EXPECT_TRUE(called_.empty());
  timer_.set(at + std::chrono::hours(1));
  timer_.set(at);
  run_until_called(1);
  EXPECT_GE(called_[0], at);
}

}  // namespace
}  // namespace coupler::device
