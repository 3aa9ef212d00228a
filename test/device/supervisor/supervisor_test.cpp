// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sched.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <csignal>
#include <functional>
#include <thread>
#include <utility>

#include "coupler/device/supervisor/shared_memory.hpp"
#include "coupler/device/supervisor/supervisor.hpp"
#include "test/device/core/fake_log.hpp"

namespace coupler::device {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::SizeIs;

using Life = std::function<int(SupervisorLink&)>;

/// A supervisor and the worker processes that it forks; these know by their inherited memory how many there
/// were before.
class Supervised : public testing::Test, public Workload {
 public:
  int serve(SupervisorLink& supervisor, std::vector<OpenConnection> clients) override {
    clients_ = std::move(clients);
    return life_(supervisor);
  }
  void reload(pid_t) override {
    ++reloads_[0];
    map_changed_ = reload_is_good_;
  }
  bool look_after(TimePoint) override {
    return std::exchange(lines_changed_, false) || std::exchange(map_changed_, false);
  }
  void change(std::vector<OpenConnection>& clients) override {
    ++changes_;
    clients_kept_ = clients.size();
  }
  std::size_t begin_safe() override {
    ++safe_calls_[0];
    return parts_;
  }
  bool drive_safe(std::size_t part) override { return drive_safe_(part); }
  bool went_safe(const std::vector<SafeOutcome>& parts) override {
    outcomes_ = parts;
    return has_durations_;
  }
  bool end_durations(const std::vector<SafeOutcome>& parts) override {
    ++durations_ended_[0];
    return parts == outcomes_;
  }
  bool make_firmware_safe() override {
    ++firmware_calls_[0];
    return make_firmware_safe_();
  }
  bool has_firmware() const override { return make_firmware_safe_ != nullptr; }

 protected:
  void beat() override {
    if (changes_ >= changes_wanted_ && ++beats_ == enough_) ::kill(::getpid(), SIGTERM);
  }
  int ended_before() const { return safe_calls_[0]; }
  /// Beats until it is told to stop.
  static int beat_for_ever(SupervisorLink& supervisor) {
    Loop loop;
    const Signals signals(loop);
    supervisor.watch(loop);
    while (signals.stop() == 0 && !supervisor.wants_room()) {
      supervisor.beat();
      loop.run_once(std::chrono::milliseconds(10));
    }
    return 0;
  }
  bool supervise(Life life) {
    life_ = std::move(life);
    return Supervisor(loop_, signals_, *this, log_).run();
  }

  Loop loop_;
  Signals signals_{loop_};
  FakeLog log_;
  std::size_t parts_ = 1;  ///< of the outputs
  std::function<bool(std::size_t part)> drive_safe_ = [](std::size_t) { return true; };
  std::vector<SafeOutcome> outcomes_;  ///< of the parts, as they were told last
  bool has_durations_ = false;
  SharedArray<std::atomic<int>> durations_ended_{1};
  std::function<bool()> make_firmware_safe_;  ///< empty: there is no firmware
  // Processes that were forked count here, too.
  SharedArray<std::atomic<int>> safe_calls_{1};
  SharedArray<std::atomic<int>> firmware_calls_{1};
  int beats_ = 0;
  int enough_ = 3;          ///< beats, then the test is over
  int changes_wanted_ = 0;  ///< before any beat counts
  Life life_;
  std::vector<OpenConnection> clients_;       ///< a worker process began with
  SharedArray<std::atomic<int>> reloads_{1};  ///< a worker process sees them, too
  bool reload_is_good_ = true;
  bool lines_changed_ = false;
  bool map_changed_ = false;
  int changes_ = 0;
  std::size_t clients_kept_ = 0;  ///< at the last change
};

TEST_F(Supervised, A_signal_ends_both_and_the_outputs_are_safe) {
  EXPECT_TRUE(supervise(beat_for_ever));
  EXPECT_EQ(safe_calls_[0], 1);
  EXPECT_THAT(log_.lines, testing::IsEmpty());
}

TEST_F(Supervised, A_process_that_is_killed_leaves_safe_outputs_and_is_started_again) {
  supervise([&](SupervisorLink& supervisor) {
    if (ended_before() == 0) ::kill(::getpid(), SIGKILL);
    return beat_for_ever(supervisor);
  });
  EXPECT_EQ(safe_calls_[0], 2);
  EXPECT_THAT(log_.lines, ElementsAre(AllOf(HasSubstr("was killed by signal 9"), HasSubstr("safe state"),
                                            HasSubstr("starting it again in 100 ms"))));
}

TEST_F(Supervised, A_process_that_exits_is_started_again) {
  supervise([&](SupervisorLink& supervisor) { return ended_before() < 2 ? 3 : beat_for_ever(supervisor); });
  EXPECT_EQ(safe_calls_[0], 3);
  ASSERT_THAT(log_.lines, SizeIs(2));
  EXPECT_THAT(log_.lines[1], AllOf(HasSubstr("exited with status 3"), HasSubstr("in 200 ms")));
}

TEST_F(Supervised, A_process_that_stands_still_is_killed_and_started_again) {
  supervise([&](SupervisorLink& supervisor) {
    if (ended_before() == 0) ::kill(::getpid(), SIGSTOP);
    return beat_for_ever(supervisor);
  });
  EXPECT_EQ(safe_calls_[0], 2);
  EXPECT_THAT(log_.lines, ElementsAre(AllOf(HasSubstr("was silent for "), HasSubstr("signal 9"))));
}

TEST_F(Supervised, A_process_that_does_not_want_to_end_is_killed) {
  enough_ = 1;
  supervise([](SupervisorLink& supervisor) -> int {
    for (;;) {
      supervisor.beat();
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
  });
  EXPECT_EQ(safe_calls_[0], 1);
}

TEST_F(Supervised, Outputs_that_cannot_be_driven_are_told) {
  drive_safe_ = [](std::size_t) { return false; };
  EXPECT_FALSE(supervise(
      [&](SupervisorLink& supervisor) { return ended_before() == 0 ? 0 : beat_for_ever(supervisor); }));
  EXPECT_THAT(log_.lines, ElementsAre(HasSubstr("not every output could be driven")));
}

/// A socket pair: the end of a client, and what the node has of it.
struct Client {
  Client() {
    std::array<int, 2> pair{};
    EXPECT_EQ(::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, pair.data()), 0);
    mine = Descriptor(pair[0]);
    nodes.socket = Descriptor(pair[1]);
  }
  Descriptor mine;
  OpenConnection nodes;
};

TEST_F(Supervised, A_reload_replaces_the_process_and_leaves_outputs_and_clients_alone) {
  Client client;
  client.nodes.has_written = true;
  client.nodes.unread = {1, 2, 3};
  client.nodes.unsent = {4};
  changes_wanted_ = 1;
  supervise([&](SupervisorLink& supervisor) {
    if (changes_ == 0) {
      supervisor.beat();
      ::kill(::getppid(), SIGHUP);
      const int status = beat_for_ever(supervisor);
      supervisor.give(client.nodes);
      return status;
    }
    const OpenConnection& same = clients_.at(0);
    const bool good =
        same.has_written && same.unread == client.nodes.unread && same.unsent == client.nodes.unsent;
    [[maybe_unused]] const ssize_t written = ::write(same.socket.get(), good ? "good" : "bad!", 4);
    return beat_for_ever(supervisor);
  });
  EXPECT_EQ(reloads_[0], 1);
  EXPECT_EQ(changes_, 1);
  EXPECT_EQ(clients_kept_, 1U);
  EXPECT_EQ(safe_calls_[0], 1) << "at the end, not in between";
  EXPECT_THAT(log_.lines, testing::IsEmpty());
  std::array<char, 5> said{};
  EXPECT_EQ(::recv(client.mine.get(), said.data(), 4, MSG_DONTWAIT), 4);
  EXPECT_STREQ(said.data(), "good");
}

TEST_F(Supervised, A_reload_that_is_refused_leaves_the_process_alone) {
  reload_is_good_ = false;
  enough_ = 20;
  supervise([&](SupervisorLink& supervisor) {
    ::kill(::getppid(), SIGHUP);
    return beat_for_ever(supervisor);
  });
  EXPECT_EQ(reloads_[0], 1);
  EXPECT_EQ(changes_, 0);
  EXPECT_EQ(safe_calls_[0], 1);
}

TEST_F(Supervised, Signals_in_quick_succession_are_not_taken_for_silence) {
  reload_is_good_ = false;
  enough_ = 2;
  supervise([&](SupervisorLink& supervisor) {
    supervisor.beat();
    // Each cuts a turn of the loop short: more of them than turns fit into the supervisor's timeout.
    for (int i = 0; i < 15; ++i) {
      ::kill(::getppid(), SIGHUP);
      while (reloads_[0] == i) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return beat_for_ever(supervisor);
  });
  EXPECT_EQ(reloads_[0], 15);
  EXPECT_EQ(safe_calls_[0], 1) << "at the end, not in between";
  EXPECT_THAT(log_.lines, testing::IsEmpty());
}

TEST_F(Supervised, Lines_that_come_and_go_are_a_reason_to_replace_the_process) {
  lines_changed_ = true;
  changes_wanted_ = 1;
  supervise(beat_for_ever);
  EXPECT_EQ(changes_, 1);
  EXPECT_EQ(safe_calls_[0], 1);
}

TEST_F(Supervised, A_process_that_does_not_make_room_leaves_safe_outputs) {
  lines_changed_ = true;
  changes_wanted_ = 1;
  supervise([&](SupervisorLink& supervisor) -> int {
    if (changes_ > 0) return beat_for_ever(supervisor);
    for (;;) {
      supervisor.beat();
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
  });
  EXPECT_EQ(changes_, 1);
  EXPECT_EQ(safe_calls_[0], 2);
  EXPECT_THAT(log_.lines, ElementsAre(HasSubstr("was killed by signal 9")));
}

TEST_F(Supervised, An_end_that_was_asked_for_leaves_the_firmware_to_the_process_that_served) {
  make_firmware_safe_ = [] { return true; };
  EXPECT_TRUE(supervise(beat_for_ever));
  EXPECT_EQ(firmware_calls_[0], 0);
}

TEST_F(Supervised, A_process_that_is_asked_to_end_twice_ends_in_order) {
  make_firmware_safe_ = [] { return true; };
  EXPECT_TRUE(supervise([](SupervisorLink& supervisor) {
    const int status = beat_for_ever(supervisor);
    ::raise(SIGTERM);  // by a service manager that asks all processes of a service
    return status;
  }));
  EXPECT_EQ(safe_calls_[0], 1);
  EXPECT_EQ(firmware_calls_[0], 0) << "it was taken for one that died";
}

TEST_F(Supervised, A_process_that_died_has_its_firmware_made_safe_by_another_one) {
  const pid_t self = ::getpid();
  make_firmware_safe_ = [&] { return ::getpid() != self; };
  supervise([&](SupervisorLink& supervisor) {
    if (ended_before() == 0) ::kill(::getpid(), SIGKILL);
    return beat_for_ever(supervisor);
  });
  EXPECT_EQ(firmware_calls_[0], 1);
  EXPECT_THAT(log_.lines, ElementsAre(HasSubstr("outputs are in their safe state")));
}

TEST_F(Supervised, Firmware_that_dies_or_never_returns_costs_its_own_outputs_only) {
  for (const bool dies : {true, false}) {
    safe_calls_[0] = beats_ = 0;
    log_.lines.clear();
    make_firmware_safe_ = [&]() -> bool {
      if (dies) ::kill(::getpid(), SIGSEGV);
      for (;;) std::this_thread::sleep_for(std::chrono::hours(1));
    };
    Signals again(loop_);
    life_ = [&](SupervisorLink& supervisor) { return ended_before() == 0 ? 3 : beat_for_ever(supervisor); };
    EXPECT_TRUE(Supervisor(loop_, again, *this, log_).run()) << "the end that was asked for is a good one";
    EXPECT_EQ(safe_calls_[0], 2);
    EXPECT_THAT(log_.lines, ElementsAre(HasSubstr("not every output could be driven to its safe state")));
  }
}

TEST_F(Supervised, Lines_that_hang_do_not_hang_the_supervisor) {
  drive_safe_ = [&](std::size_t) {
    if (safe_calls_[0] == 1)
      for (;;) std::this_thread::sleep_for(std::chrono::hours(1));
    return true;
  };
  EXPECT_TRUE(supervise(
      [&](SupervisorLink& supervisor) { return ended_before() == 0 ? 3 : beat_for_ever(supervisor); }));
  EXPECT_THAT(log_.lines, ElementsAre(HasSubstr("not every output could be driven to its safe state")));
}

TEST_F(Supervised, Lines_that_hang_keep_no_others_from_their_safe_state) {
  SharedArray<std::atomic<bool>> is_safe(1);
  parts_ = 2;
  has_durations_ = true;
  drive_safe_ = [&](std::size_t part) {
    if (part == 0)
      for (;;) ::pause();
    return is_safe[0] = true;
  };
  EXPECT_FALSE(supervise(beat_for_ever));
  EXPECT_TRUE(is_safe[0]);
  EXPECT_THAT(outcomes_, ElementsAre(SafeOutcome::hangs, SafeOutcome::safe));
  EXPECT_EQ(durations_ended_[0], 1) << "they end, too";
}

TEST_F(Supervised, Durations_end_only_where_there_are_some) {
  EXPECT_TRUE(supervise(beat_for_ever));
  EXPECT_THAT(outcomes_, ElementsAre(SafeOutcome::safe));
  EXPECT_EQ(durations_ended_[0], 0);
}

TEST_F(Supervised, Durations_end_while_the_firmware_takes_its_time) {
  has_durations_ = true;
  make_firmware_safe_ = [&] {
    while (durations_ended_[0] == 0) ::sched_yield();
    return true;
  };
  supervise([&](SupervisorLink& supervisor) {
    if (ended_before() == 0) ::kill(::getpid(), SIGKILL);
    return beat_for_ever(supervisor);
  });
  EXPECT_THAT(log_.lines, ElementsAre(HasSubstr("; outputs are in their safe state")));
}

TEST_F(Supervised, A_supervisor_that_is_stopped_is_silent_to_its_process_until_it_goes_on) {
  SharedArray<std::atomic<int>> heard(1);
  enough_ = 1000;
  supervise([&](SupervisorLink& supervisor) {
    Loop loop;
    supervisor.watch(loop);
    ::kill(::getppid(), SIGSTOP);
    TimePoint now = TimePoint::clock::now();
    while (!supervisor.is_silent(now)) now = loop.run_once(heartbeat_period);
    ::kill(::getppid(), SIGCONT);
    do now = loop.run_once(heartbeat_period);
    while (supervisor.is_silent(now));
    heard[0] = 1;
    ::kill(::getppid(), SIGTERM);
    return 0;
  });
  EXPECT_EQ(heard[0], 1);
}

/// A process of somebody else, whom this one may not kill, is to its supervisor like one in a call of the
/// kernel that hangs.
TEST_F(Supervised, A_process_that_cannot_be_killed_does_not_hang_the_supervisor) {
  if (::geteuid() != 0) GTEST_SKIP() << "only root can become somebody else";
  constexpr uid_t nobody = 65534;
  SharedArray<std::atomic<int>> lives(1);
  SharedArray<std::atomic<bool>> may_end(1);
  enough_ = 1'000'000;
  ASSERT_EQ(::setresuid(nobody, nobody, 0), 0);
  supervise([&](SupervisorLink& supervisor) {
    const int life = lives[0]++;
    if (life == 0) {
      if (::setresuid(0, 0, 0) != 0) return 3;
      while (!may_end[0]) std::this_thread::sleep_for(std::chrono::milliseconds(10));
      return 0;
    }
    may_end[0] = true;
    if (life == 2) ::kill(::getppid(), SIGTERM);
    return beat_for_ever(supervisor);
  });
  ASSERT_EQ(::setresuid(0, 0, 0), 0);
  EXPECT_THAT(log_.lines,
              ElementsAre(AllOf(HasSubstr("was silent for "), HasSubstr("hangs in a system call")),
                          HasSubstr("was replaced: an earlier one, which hung")));
  EXPECT_EQ(safe_calls_[0], 3) << "once more after the one that hung has ended";
}

}  // namespace
}  // namespace coupler::device
