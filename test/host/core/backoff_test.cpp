// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/core/backoff.hpp"

#include <gtest/gtest.h>

namespace coupler::host {
namespace {

using std::chrono::milliseconds;

TEST(Backoff, The_wait_doubles_from_a_tenth_of_a_second_up_to_5_seconds) {
  Backoff backoff;
  for (const int expected : {100, 200, 400, 800, 1600, 3200, 5000, 5000})
    EXPECT_EQ(backoff.next(), milliseconds(expected));
}

TEST(Backoff, After_a_success_it_begins_anew) {
  Backoff backoff;
  backoff.next();
  backoff.next();
  backoff.reset();
  EXPECT_EQ(backoff.next(), milliseconds(100));
}

}  // namespace
}  // namespace coupler::host
