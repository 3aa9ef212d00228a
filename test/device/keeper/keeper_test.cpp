// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <thread>

#include "device/keeper/keeper.hpp"
#include "test/device/core/fake_lines.hpp"
#include "test/device/core/fake_log.hpp"

namespace coupler::node {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::SizeIs;

/// A keeper and the I/O processes that it forks; these know by their inherited memory how many there were
/// before.
class Kept : public testing::Test, public Pulse {
 protected:
  void beat() override {
    if (++beats_ == enough_) ::kill(::getpid(), SIGTERM);
  }
  int ended_before() const { return lines_.safe_calls; }
  /// Beats until it is told to stop.
  static int beat_for_ever(Pulse& pulse) {
    Loop loop;
    const Signals signals(loop);
    while (signals.stop() == 0) {
      pulse.beat();
      loop.run_once(std::chrono::milliseconds(10));
    }
    return 0;
  }
  bool keep(const IoProcess::Work& work) { return Keeper(loop_, signals_, lines_, log_, this).run(work); }

  Loop loop_;
  const Signals signals_{loop_};
  FakeLines lines_;
  FakeLog log_;
  int beats_ = 0;
  int enough_ = 3;  ///< beats, then the test is over
};

TEST_F(Kept, A_signal_ends_both_and_the_outputs_are_safe) {
  EXPECT_TRUE(keep(beat_for_ever));
  EXPECT_EQ(lines_.safe_calls, 1);
  EXPECT_THAT(log_.lines, testing::IsEmpty());
}

TEST_F(Kept, A_process_that_is_killed_leaves_safe_outputs_and_is_started_again) {
  keep([&](Pulse& pulse) {
    if (ended_before() == 0) ::kill(::getpid(), SIGKILL);
    return beat_for_ever(pulse);
  });
  EXPECT_EQ(lines_.safe_calls, 2);
  EXPECT_THAT(log_.lines, ElementsAre(AllOf(HasSubstr("was killed by signal 9"), HasSubstr("safe state"),
                                            HasSubstr("starting it again in 100 ms"))));
}

TEST_F(Kept, A_process_that_exits_is_started_again) {
  keep([&](Pulse& pulse) { return ended_before() < 2 ? 3 : beat_for_ever(pulse); });
  EXPECT_EQ(lines_.safe_calls, 3);
  ASSERT_THAT(log_.lines, SizeIs(2));
  EXPECT_THAT(log_.lines[1], AllOf(HasSubstr("exited with status 3"), HasSubstr("in 200 ms")));
}

TEST_F(Kept, A_process_that_stands_still_is_killed_and_started_again) {
  keep([&](Pulse& pulse) {
    if (ended_before() == 0) ::kill(::getpid(), SIGSTOP);
    return beat_for_ever(pulse);
  });
  EXPECT_EQ(lines_.safe_calls, 2);
  EXPECT_THAT(log_.lines, ElementsAre(AllOf(HasSubstr("was silent for 1 s"), HasSubstr("signal 9"))));
}

TEST_F(Kept, A_process_that_does_not_want_to_end_is_killed) {
  enough_ = 1;
  keep([](Pulse& pulse) -> int {
    for (;;) {
      pulse.beat();
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
  });
  EXPECT_EQ(lines_.safe_calls, 1);
}

TEST_F(Kept, Outputs_that_cannot_be_driven_are_told) {
  lines_.broken = true;
  EXPECT_FALSE(keep([&](Pulse& pulse) { return ended_before() == 0 ? 0 : beat_for_ever(pulse); }));
  EXPECT_THAT(log_.lines, ElementsAre(HasSubstr("not every output could be driven")));
}

}  // namespace
}  // namespace coupler::node
