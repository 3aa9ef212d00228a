// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/node/realtime.hpp"
#include "coupler/device/node/point_hooks.hpp"

#include <gtest/gtest.h>
#include <sched.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <fstream>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

namespace coupler::device {
namespace {

/// The exit status of a process of its own that does this: the test's is to stay as it is.
int in_a_process(const std::function<int()>& life) {
  const pid_t pid = ::fork();
  if (pid == 0) ::_exit(life());
  int status = -1;
  ::waitpid(pid, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

int policy_of_this_thread() { return ::sched_getscheduler(0) & ~SCHED_RESET_ON_FORK; }

/// As the kernel schedules this thread now: below -1 ahead of every ordinary one.
long priority_of_this_thread() {
  std::ifstream file("/proc/thread-self/stat");
  std::string text;
  std::getline(file, text);
  std::size_t at = text.rfind(')');
  constexpr int fields_between = 16;
  for (int i = 0; i < fields_between; ++i) at = text.find(' ', at + 1);
  return std::stol(text.substr(at + 1));
}

class Realtime : public testing::Test {
 protected:
  void SetUp() override {
    if (in_a_process([] { return become_realtime(RealtimePriority::worker) ? 0 : 1; }) != 0)
      GTEST_SKIP() << "this user may not have real-time priority or lock memory";
  }
};

TEST_F(Realtime, The_thread_that_asks_for_it_has_it) {
  EXPECT_EQ(in_a_process([] {
              (void)become_realtime(RealtimePriority::supervisor);
              sched_param parameters{};
              ::sched_getparam(0, &parameters);
              return policy_of_this_thread() == SCHED_FIFO ? parameters.sched_priority : -1;
            }),
            11);
}

TEST_F(Realtime, Threads_that_are_started_later_have_ordinary_priority) {
  EXPECT_EQ(in_a_process([] {
              (void)become_realtime(RealtimePriority::worker);
              int policy = -1;
              std::thread([&] { policy = policy_of_this_thread(); }).join();
              return policy;
            }),
            SCHED_OTHER);
}

TEST_F(Realtime, So_have_processes_which_can_ask_for_it_themselves) {
  EXPECT_EQ(in_a_process([] {
              (void)become_realtime(RealtimePriority::supervisor);
              if (in_a_process(policy_of_this_thread) != SCHED_OTHER) return -1;
              return in_a_process(
                  [] { return become_realtime(RealtimePriority::worker) ? policy_of_this_thread() : -1; });
            }),
            SCHED_FIFO);
}

TEST_F(Realtime, Who_holds_a_mutex_that_an_urgent_thread_waits_for_is_as_urgent) {
  EXPECT_EQ(in_a_process([] {
              (void)become_realtime(RealtimePriority::worker);
              UrgentMutex mutex;
              std::atomic<bool> is_held = false;
              std::atomic<bool> became_urgent = false;
              std::thread ordinary([&] {
                const std::lock_guard lock(mutex);
                is_held = true;
                const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
                while (!became_urgent && std::chrono::steady_clock::now() < end)
                  became_urgent = priority_of_this_thread() < -1;
              });
              while (!is_held) std::this_thread::sleep_for(std::chrono::milliseconds(1));
              const std::lock_guard lock(mutex);
              ordinary.join();
              return became_urgent ? 0 : 1;
            }),
            0);
}

}  // namespace
}  // namespace coupler::device
