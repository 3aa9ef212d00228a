// SPDX-License-Identifier: Apache-2.0
#include "coupler/tools/interruption.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <future>

namespace coupler::tools {
namespace {

TEST(Interruption, SIGINT_and_SIGTERM_are_told_and_do_not_end_the_program) {
  for (const int signal : {SIGINT, SIGTERM}) {
    std::promise<void> told;
    const Interruption interruption([&told] { told.set_value(); });
    ::kill(::getpid(), signal);
    ASSERT_EQ(told.get_future().wait_for(std::chrono::seconds(20)), std::future_status::ready);
  }
}

TEST(Interruption, Without_a_signal_it_calls_nothing_and_ends) {
  bool called = false;
  {
    const Interruption interruption([&called] { called = true; });
  }
  EXPECT_FALSE(called);
}

}  // namespace
}  // namespace coupler::tools
