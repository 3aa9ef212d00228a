// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "coupler/host/core/wakeup.hpp"

namespace coupler::host {
namespace {

using std::chrono::milliseconds;

std::chrono::nanoseconds time_of_test{0};

TEST(Deadline, It_passes_while_the_machine_is_suspended) {
  time_of_test = milliseconds(5);
  const Deadline deadline(milliseconds(200), [] { return time_of_test; });
  EXPECT_EQ(deadline.left(), 200);
  time_of_test += milliseconds(199);
  EXPECT_EQ(deadline.left(), 1);
  EXPECT_FALSE(deadline.has_passed());
  time_of_test += std::chrono::hours(1);  // of sleep
  EXPECT_EQ(deadline.left(), 0);
  EXPECT_TRUE(deadline.has_passed());
}

TEST(Deadline, Its_clock_is_that_of_the_machine_with_the_time_of_sleep) {
  EXPECT_GE(time_since_boot(), std::chrono::steady_clock::now().time_since_epoch());
}

}  // namespace
}  // namespace coupler::host
