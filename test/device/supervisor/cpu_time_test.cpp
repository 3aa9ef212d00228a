// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/supervisor/cpu_time.hpp"

#include <gtest/gtest.h>
#include <sched.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <functional>
#include <string>
#include <thread>

#include "coupler/device/supervisor/child.hpp"

namespace coupler::device {
namespace {

using std::chrono::milliseconds;
using std::chrono::nanoseconds;
using std::chrono::seconds;

class Estimated : public testing::Test {
 protected:
  /// What the kernel says, a tenth of a second after the last time.
  nanoseconds look(milliseconds ran, milliseconds waited, bool is_runnable) {
    now_ += milliseconds(100);
    return estimate_.add({ran, waited, is_runnable}, now_);
  }

  TimePoint now_{seconds(1000)};
  WaitEstimate estimate_;
};

TEST_F(Estimated, What_the_kernel_has_counted_is_taken) {
  EXPECT_EQ(look(milliseconds(10), milliseconds(20), false), milliseconds(20));
  EXPECT_EQ(look(milliseconds(15), milliseconds(70), true), milliseconds(70));
}

TEST_F(Estimated, A_wait_that_has_not_ended_counts_as_it_grows) {
  look(milliseconds(10), milliseconds(20), true);
  EXPECT_EQ(look(milliseconds(10), milliseconds(20), true), milliseconds(120));
  EXPECT_EQ(look(milliseconds(10), milliseconds(20), true), milliseconds(220));
}

TEST_F(Estimated, A_wait_that_has_ended_is_not_counted_twice) {
  look(milliseconds(10), milliseconds(20), true);
  look(milliseconds(10), milliseconds(20), true);
  EXPECT_EQ(look(milliseconds(10), milliseconds(170), true), milliseconds(170));
  EXPECT_EQ(look(milliseconds(10), milliseconds(170), true), milliseconds(270)) << "the next one";
}

TEST_F(Estimated, A_process_that_runs_does_not_wait) {
  for (int ran = 10; ran < 100; ran += 10)
    EXPECT_EQ(look(milliseconds(ran), milliseconds(20), true), milliseconds(20));
}

TEST_F(Estimated, A_process_that_is_seen_to_run_later_has_not_waited) {
  look(milliseconds(10), milliseconds(20), true);
  EXPECT_EQ(look(milliseconds(10), milliseconds(20), true), milliseconds(120)) << "before the kernel's tick";
  EXPECT_EQ(look(milliseconds(210), milliseconds(20), true), milliseconds(20));
}

TEST_F(Estimated, A_process_that_is_blocked_does_not_wait) {
  look(milliseconds(10), milliseconds(20), false);
  EXPECT_EQ(look(milliseconds(10), milliseconds(20), false), milliseconds(20));
}

TEST_F(Estimated, A_child_that_has_never_run_waits) {
  look(milliseconds(0), milliseconds(0), true);
  EXPECT_EQ(look(milliseconds(0), milliseconds(0), true), milliseconds(100));
}

TEST(CpuWait, A_process_that_is_gone_waits_no_longer) {
  CpuWait wait(0x7FFFFFFF);
  EXPECT_FALSE(wait.is_counted());
  EXPECT_EQ(wait.sample(TimePoint(seconds(1))), nanoseconds(0));
}

[[noreturn]] void spin() {
  for (volatile unsigned turn = 0;; turn = turn + 1) {
  }
}

/// A child that ends with the test.
Child forked(const std::function<void()>& life) {
  const pid_t parent = ::getpid();
  return *Child::start([&] {
    if (end_with_parent(parent, SIGKILL)) life();
    return 0;
  });
}

/// This process, from now on, on the first CPU that it may use.
void stay_on_one_cpu() {
  cpu_set_t all;
  CPU_ZERO(&all);
  ::sched_getaffinity(0, sizeof all, &all);
  for (int cpu = 0; cpu < CPU_SETSIZE; ++cpu) {
    if (!CPU_ISSET(cpu, &all)) continue;
    CPU_ZERO(&all);
    CPU_SET(cpu, &all);
    break;
  }
  ::sched_setaffinity(0, sizeof all, &all);
}

/// Until it sleeps: on a busy machine it may have to wait for its first turn.
void await_sleep(pid_t pid) {
  std::string state;
  while (state != "S") {
    std::ifstream stat("/proc/" + std::to_string(pid) + "/stat");
    stat >> state >> state >> state;  // its number, its name in brackets, its state
    std::this_thread::sleep_for(milliseconds(1));
  }
}

/// Looks at it for a while; how much of the time until then it has waited, and that time.
struct Seen {
  nanoseconds waited;
  nanoseconds elapsed;
};
Seen look_at(pid_t pid) {
  CpuWait wait(pid);
  const TimePoint start = TimePoint::clock::now();
  const nanoseconds before = wait.sample(start);
  nanoseconds waited = before;
  for (int i = 0; i < 20; ++i) {
    std::this_thread::sleep_for(milliseconds(50));
    waited = wait.sample(TimePoint::clock::now());
  }
  return {waited - before, TimePoint::clock::now() - start};
}

class RealProcess : public testing::Test {
 protected:
  void SetUp() override {
    if (!CpuWait(::getpid()).is_counted())
      GTEST_SKIP() << "this kernel does not count waits for the CPU (/proc/self/schedstat is all zeros)";
  }
};

TEST_F(RealProcess, One_that_gets_no_CPU_waits) {
  const Child idle = forked([] {
    stay_on_one_cpu();
    const sched_param none{};
    ::sched_setscheduler(0, SCHED_IDLE, &none);
    spin();
  });
  const Child busy = forked([] {
    stay_on_one_cpu();
    spin();
  });
  const Seen seen = look_at(idle.pid());
  EXPECT_GT(seen.waited, seen.elapsed / 2);
}

TEST_F(RealProcess, One_that_is_stopped_does_not_wait) {
  const Child stopped = forked([] { spin(); });
  ::kill(stopped.pid(), SIGSTOP);
  ASSERT_EQ(::waitpid(stopped.pid(), nullptr, WUNTRACED), stopped.pid());
  const Seen seen = look_at(stopped.pid());
  EXPECT_LT(seen.waited, seen.elapsed / 4);
}

TEST_F(RealProcess, One_that_sleeps_does_not_wait) {
  const Child sleeping = forked([] {
    for (;;) ::pause();
  });
  await_sleep(sleeping.pid());
  const Seen seen = look_at(sleeping.pid());
  EXPECT_LT(seen.waited, seen.elapsed / 4);
}

}  // namespace
}  // namespace coupler::device
