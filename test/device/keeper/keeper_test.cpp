// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <csignal>
#include <functional>
#include <thread>
#include <utility>

#include "device/keeper/keeper.hpp"
#include "device/keeper/shared_array.hpp"
#include "test/device/core/fake_lines.hpp"
#include "test/device/core/fake_log.hpp"

namespace coupler::node {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::SizeIs;

using Life = std::function<int(Superior&)>;

/// A keeper and the I/O processes that it forks; these know by their inherited memory how many there were
/// before.
class Kept : public testing::Test, public Pulse, public Charge {
 public:
  int serve(Superior& superior, std::vector<OpenConnection> clients) override {
    clients_ = std::move(clients);
    return life_(superior);
  }
  bool reload() override {
    ++reloads_[0];
    return reload_is_good_;
  }
  bool look_after(TimePoint) override { return std::exchange(lines_changed_, false); }
  void change(std::vector<OpenConnection>& clients) override {
    ++changes_;
    clients_kept_ = clients.size();
  }
  bool make_safe() override { return lines_.drive_safe(); }

 protected:
  void beat() override {
    if (++beats_ == enough_) ::kill(::getpid(), SIGTERM);
  }
  int ended_before() const { return lines_.safe_calls; }
  /// Beats until it is told to stop.
  static int beat_for_ever(Superior& superior) {
    Loop loop;
    const Signals signals(loop);
    superior.watch(loop);
    while (signals.stop() == 0 && !superior.wants_room()) {
      superior.beat();
      loop.run_once(std::chrono::milliseconds(10));
    }
    return 0;
  }
  bool keep(Life life, std::vector<OpenConnection> clients = {}) {
    life_ = std::move(life);
    return Keeper(loop_, signals_, *this, log_, this).run(std::move(clients));
  }

  Loop loop_;
  Signals signals_{loop_};
  FakeLines lines_;
  FakeLog log_;
  int beats_ = 0;
  int enough_ = 3;  ///< beats, then the test is over
  Life life_;
  std::vector<OpenConnection> clients_;       ///< an I/O process began with
  SharedArray<std::atomic<int>> reloads_{1};  ///< an I/O process sees them, too
  bool reload_is_good_ = true;
  bool lines_changed_ = false;
  int changes_ = 0;
  std::size_t clients_kept_ = 0;  ///< at the last change
};

TEST_F(Kept, A_signal_ends_both_and_the_outputs_are_safe) {
  EXPECT_TRUE(keep(beat_for_ever));
  EXPECT_EQ(lines_.safe_calls, 1);
  EXPECT_THAT(log_.lines, testing::IsEmpty());
}

TEST_F(Kept, A_process_that_is_killed_leaves_safe_outputs_and_is_started_again) {
  keep([&](Superior& pulse) {
    if (ended_before() == 0) ::kill(::getpid(), SIGKILL);
    return beat_for_ever(pulse);
  });
  EXPECT_EQ(lines_.safe_calls, 2);
  EXPECT_THAT(log_.lines, ElementsAre(AllOf(HasSubstr("was killed by signal 9"), HasSubstr("safe state"),
                                            HasSubstr("starting it again in 100 ms"))));
}

TEST_F(Kept, The_first_process_goes_on_with_clients_that_were_there_before) {
  std::vector<OpenConnection> one(1);
  one[0].unread = {1, 2, 3};
  keep(
      [&](Superior& pulse) {
        return clients_.size() == 1 && clients_[0].unread.size() == 3 ? beat_for_ever(pulse) : 3;
      },
      std::move(one));
  EXPECT_THAT(log_.lines, testing::IsEmpty());
}

TEST_F(Kept, A_process_that_exits_is_started_again) {
  keep([&](Superior& pulse) { return ended_before() < 2 ? 3 : beat_for_ever(pulse); });
  EXPECT_EQ(lines_.safe_calls, 3);
  ASSERT_THAT(log_.lines, SizeIs(2));
  EXPECT_THAT(log_.lines[1], AllOf(HasSubstr("exited with status 3"), HasSubstr("in 200 ms")));
}

TEST_F(Kept, A_process_that_stands_still_is_killed_and_started_again) {
  keep([&](Superior& pulse) {
    if (ended_before() == 0) ::kill(::getpid(), SIGSTOP);
    return beat_for_ever(pulse);
  });
  EXPECT_EQ(lines_.safe_calls, 2);
  EXPECT_THAT(log_.lines, ElementsAre(AllOf(HasSubstr("was silent for 1 s"), HasSubstr("signal 9"))));
}

TEST_F(Kept, A_process_that_does_not_want_to_end_is_killed) {
  enough_ = 1;
  keep([](Superior& pulse) -> int {
    for (;;) {
      pulse.beat();
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
  });
  EXPECT_EQ(lines_.safe_calls, 1);
}

TEST_F(Kept, Outputs_that_cannot_be_driven_are_told) {
  lines_.broken = true;
  EXPECT_FALSE(keep([&](Superior& pulse) { return ended_before() == 0 ? 0 : beat_for_ever(pulse); }));
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

TEST_F(Kept, A_reload_replaces_the_process_and_leaves_outputs_and_clients_alone) {
  Client client;
  client.nodes.has_written = true;
  client.nodes.unread = {1, 2, 3};
  client.nodes.unsent = {4};
  enough_ = 20;
  keep([&](Superior& superior) {
    if (changes_ == 0) {
      superior.beat();
      ::kill(::getppid(), SIGHUP);
      const int status = beat_for_ever(superior);
      superior.give(client.nodes);
      return status;
    }
    const OpenConnection& same = clients_.at(0);
    const bool good =
        same.has_written && same.unread == client.nodes.unread && same.unsent == client.nodes.unsent;
    [[maybe_unused]] const ssize_t written = ::write(same.socket.get(), good ? "good" : "bad!", 4);
    return beat_for_ever(superior);
  });
  EXPECT_EQ(reloads_[0], 1);
  EXPECT_EQ(changes_, 1);
  EXPECT_EQ(clients_kept_, 1U);
  EXPECT_EQ(lines_.safe_calls, 1) << "at the end, not in between";
  EXPECT_THAT(log_.lines, testing::IsEmpty());
  std::array<char, 5> said{};
  EXPECT_EQ(::recv(client.mine.get(), said.data(), 4, MSG_DONTWAIT), 4);
  EXPECT_STREQ(said.data(), "good");
}

TEST_F(Kept, A_reload_that_is_refused_leaves_the_process_alone) {
  reload_is_good_ = false;
  enough_ = 20;
  keep([&](Superior& superior) {
    ::kill(::getppid(), SIGHUP);
    return beat_for_ever(superior);
  });
  EXPECT_EQ(reloads_[0], 1);
  EXPECT_EQ(changes_, 0);
  EXPECT_EQ(lines_.safe_calls, 1);
}

TEST_F(Kept, Signals_in_quick_succession_are_not_taken_for_silence) {
  reload_is_good_ = false;
  enough_ = 2;
  keep([&](Superior& superior) {
    superior.beat();
    // Each cuts a glance short: more of them than glances fit into the keeper's patience.
    for (int i = 0; i < 15; ++i) {
      ::kill(::getppid(), SIGHUP);
      while (reloads_[0] == i) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return beat_for_ever(superior);
  });
  EXPECT_EQ(reloads_[0], 15);
  EXPECT_EQ(lines_.safe_calls, 1) << "at the end, not in between";
  EXPECT_THAT(log_.lines, testing::IsEmpty());
}

TEST_F(Kept, Lines_that_come_and_go_are_a_reason_to_replace_the_process) {
  lines_changed_ = true;
  enough_ = 20;
  keep(beat_for_ever);
  EXPECT_EQ(changes_, 1);
  EXPECT_EQ(lines_.safe_calls, 1);
}

TEST_F(Kept, A_process_that_does_not_make_room_leaves_safe_outputs) {
  lines_changed_ = true;
  enough_ = 30;
  keep([&](Superior& superior) -> int {
    if (changes_ > 0) return beat_for_ever(superior);
    for (;;) {
      superior.beat();
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
  });
  EXPECT_EQ(changes_, 1);
  EXPECT_EQ(lines_.safe_calls, 2);
  EXPECT_THAT(log_.lines, ElementsAre(HasSubstr("was killed by signal 9")));
}

}  // namespace
}  // namespace coupler::node
