// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sched.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <functional>
#include <vector>

#include "coupler/device/supervisor/safety_processes.hpp"
#include "coupler/device/supervisor/shared_memory.hpp"

namespace coupler::device {
namespace {

using testing::Each;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;

std::vector<SafeOutcome> drive_apart(const std::vector<std::function<bool()>>& works,
                                     std::vector<Child>& lost) {
  SafetyProcesses processes(lost);
  for (const auto& work : works) EXPECT_TRUE(processes.start(work));
  return processes.finish();
}

bool hang() {
  for (;;) ::pause();
}

TEST(SafetyProcesses, One_that_hangs_keeps_no_other_from_its_work) {
  SharedArray<std::atomic<bool>> done(1);
  std::vector<Child> lost;
  EXPECT_THAT(drive_apart({hang, [&] { return done[0] = true; }, hang}, lost),
              ElementsAre(SafeOutcome::hangs, SafeOutcome::safe, SafeOutcome::hangs));
  EXPECT_TRUE(done[0]);
  EXPECT_THAT(lost, IsEmpty()) << "they were killed";
}

TEST(SafetyProcesses, They_are_there_at_the_same_time) {
  SharedArray<std::atomic<int>> there(1);
  const auto meet = [&] {
    for (++there[0]; there[0] < 3;) ::sched_yield();  // not asleep: what waits for a processor may
    return true;
  };
  std::vector<Child> lost;
  EXPECT_THAT(drive_apart({meet, meet, meet}, lost), Each(SafeOutcome::safe));
}

TEST(SafetyProcesses, Work_that_fails_and_one_that_dies_are_told) {
  const auto fail = [] { return false; };
  const auto die = [] { return ::raise(SIGKILL) == 0; };
  std::vector<Child> lost;
  EXPECT_THAT(drive_apart({fail, [] { return true; }, die}, lost),
              ElementsAre(SafeOutcome::failed, SafeOutcome::safe, SafeOutcome::failed));
}

TEST(SafetyProcesses, No_work_is_no_process) {
  std::vector<Child> lost;
  EXPECT_THAT(drive_apart({}, lost), IsEmpty());
}

/// Processes of somebody else, whom this one may not kill, are like those in a call of the kernel that hangs.
TEST(SafetyProcesses, Those_that_cannot_be_killed_are_lost) {
  if (::geteuid() != 0) GTEST_SKIP() << "only root can become somebody else";
  constexpr uid_t nobody = 65534;
  SharedArray<std::atomic<bool>> may_end(1);
  const auto hang_as_root = [&]() -> bool {
    if (::setresuid(0, 0, 0) != 0) return false;
    while (!may_end[0]) ::usleep(1000);
    return true;
  };
  std::vector<Child> lost;
  ASSERT_EQ(::setresuid(nobody, nobody, 0), 0);
  const auto outcomes = drive_apart({hang_as_root, [] { return true; }, hang_as_root}, lost);
  ASSERT_EQ(::setresuid(0, 0, 0), 0);
  EXPECT_THAT(outcomes, ElementsAre(SafeOutcome::hangs, SafeOutcome::safe, SafeOutcome::hangs));
  EXPECT_THAT(lost, SizeIs(2));
  may_end[0] = true;
  for (Child& each : lost) EXPECT_TRUE(each.wait(std::chrono::seconds(20)));
}

}  // namespace
}  // namespace coupler::device
