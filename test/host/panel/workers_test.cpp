// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/panel/workers.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <future>

namespace coupler::host {
namespace {

TEST(Workers, What_was_given_to_them_is_done_before_they_end) {
  std::atomic<int> done{0};
  {
    Workers workers(4);
    for (int i = 0; i < 100; ++i) workers.add([&] { ++done; });
  }
  EXPECT_EQ(done, 100);
}

TEST(Workers, As_many_tasks_as_there_are_of_them_wait_at_a_time) {
  constexpr int number = 3;
  std::atomic<int> waiting{0};
  std::promise<void> all;
  const std::shared_future<void> all_wait(all.get_future());
  Workers workers(number);
  for (int i = 0; i < number; ++i)
    workers.add([&] {
      if (++waiting == number) all.set_value();
      all_wait.wait();
    });
  all_wait.wait();
  EXPECT_EQ(waiting, number);
}

}  // namespace
}  // namespace coupler::host
