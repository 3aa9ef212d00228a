// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "coupler/device/supervisor/supervisor.hpp"

namespace coupler::device {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

TEST(Backoff, It_doubles_up_to_its_limit) {
  Backoff backoff;
  for (const int expected : {100, 200, 400, 800, 1600, 3200, 5000, 5000})
    EXPECT_EQ(backoff.after(milliseconds(1)), milliseconds(expected));
}

TEST(Backoff, A_process_that_lived_long_is_started_at_once_again) {
  Backoff backoff;
  for (int i = 0; i < 5; ++i) backoff.after(seconds(9));
  EXPECT_EQ(backoff.after(seconds(10)), Backoff::shortest);
  EXPECT_EQ(backoff.after(seconds(9)), 2 * Backoff::shortest);
}

}  // namespace
}  // namespace coupler::device
