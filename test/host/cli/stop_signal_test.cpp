// SPDX-License-Identifier: Apache-2.0
#include "host/cli/stop_signal.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <future>

namespace coupler::cli {
namespace {

TEST(StopSignal, SIGINT_and_SIGTERM_are_told_and_do_not_end_the_program) {
  for (const int signal : {SIGINT, SIGTERM}) {
    std::promise<void> told;
    StopSignal stop([&told] { told.set_value(); });
    EXPECT_FALSE(stop.has_come());
    ::kill(::getpid(), signal);
    ASSERT_EQ(told.get_future().wait_for(std::chrono::seconds(20)), std::future_status::ready);
    EXPECT_TRUE(stop.has_come());
  }
}

TEST(StopSignal, Without_a_signal_it_ends_too) {
  {
    const StopSignal stop([] {});
  }
  SUCCEED();
}

}  // namespace
}  // namespace coupler::cli
