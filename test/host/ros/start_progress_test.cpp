// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/ros/start_progress.hpp"

#include <gmock/gmock.h>

namespace coupler::host {
namespace {

TEST(StartProgress, How_far_a_long_start_is_is_said_once_in_a_period) {
  const Time begin{};
  StartProgress progress(65000, "have their topics", begin);
  EXPECT_EQ(progress.at(1, begin), std::nullopt);
  EXPECT_EQ(progress.at(12000, begin + StartProgress::period), "12000 of 65000 points have their topics");
  EXPECT_EQ(progress.at(12001, begin + StartProgress::period), std::nullopt);
  EXPECT_EQ(progress.at(20000, begin + 2 * StartProgress::period), "20000 of 65000 points have their topics");
  EXPECT_EQ(progress.at(65000, begin + 3 * StartProgress::period), std::nullopt) << "all is done";
}

}  // namespace
}  // namespace coupler::host
