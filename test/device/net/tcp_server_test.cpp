// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <pty.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>

#include "device/net/signals.hpp"
#include "test/device/net/tcp_under_test.hpp"

namespace coupler::node {
namespace {

using testing::ElementsAreArray;
using testing::HasSubstr;
using testing::StartsWith;

TEST(Listening, Port_0_takes_a_free_port_and_says_which) {
  const auto listener = listen_on("127.0.0.1", 0);
  ASSERT_TRUE(listener.has_value());
  EXPECT_THAT(listener->name, StartsWith("127.0.0.1:"));
  EXPECT_NE(listener->name, "127.0.0.1:0");
}

TEST(Listening, A_port_that_is_taken_is_named_with_the_remedy) {
  const auto first = listen_on("127.0.0.1", 0);
  ASSERT_TRUE(first.has_value());
  const auto port = static_cast<std::uint16_t>(std::stoi(first->name.substr(10)));
  const auto second = listen_on("127.0.0.1", port);
  ASSERT_FALSE(second.has_value());
  EXPECT_THAT(second.error(), HasSubstr("127.0.0.1 port " + std::to_string(port)));
  EXPECT_THAT(second.error(), HasSubstr("--port"));
}

TEST(Listening, An_address_that_is_not_this_machines_is_refused) {
  const auto foreign = listen_on("192.0.2.1", 0);
  ASSERT_FALSE(foreign.has_value());
  EXPECT_THAT(foreign.error(), HasSubstr("does not have that address"));
  EXPECT_FALSE(listen_on("not an address", 0).has_value());
}

TEST(Accepting, When_all_places_are_taken_who_never_asked_makes_room_first_then_the_longest_idle) {
  TcpUnderTest node(3);
  Client asked = node.connect();
  asked.send(question(1));
  node.settle();
  asked.received();
  Client silent = node.connect();
  Client later = node.connect();
  later.send(question(2));
  node.settle();
  later.received();

  Client fourth = node.connect();
  EXPECT_TRUE(silent.is_closed());
  EXPECT_FALSE(asked.is_closed());
  fourth.send(question(3));
  node.settle();
  EXPECT_THAT(fourth.received(), ElementsAreArray(answer_to(3)));

  Client fifth = node.connect();
  EXPECT_TRUE(asked.is_closed()) << "the longest idle";
  EXPECT_FALSE(later.is_closed());
  EXPECT_EQ(node.node.statistics.evictions, 2U);
  EXPECT_EQ(node.node.statistics.connections, 5U);
}

TEST(Accepting, A_storm_of_silent_connections_does_not_push_out_who_works) {
  TcpUnderTest node(4);
  Client worker = node.connect();
  worker.send(question(1));
  node.settle();
  EXPECT_THAT(worker.received(), ElementsAreArray(answer_to(1)));
  std::vector<Client> storm;
  for (int i = 0; i < 100; ++i) {
    storm.emplace_back(node.tcp.name());
    node.loop.run_once(std::chrono::milliseconds(50));
  }
  worker.send(question(2));
  node.settle();
  EXPECT_THAT(worker.received(), ElementsAreArray(answer_to(2)));
}

TEST(Accepting, Without_descriptors_it_waits_says_so_once_and_goes_on_when_there_are_some) {
  TcpUnderTest node;
  Client first = node.connect();
  Client waiting(node.tcp.name());
  // UBSan needs a descriptor the first time it sees a type called: let it see this one before there are none.
  Log& log = node.log;
  log.write("begins");
  rlimit old{};
  ASSERT_EQ(::getrlimit(RLIMIT_NOFILE, &old), 0);
  const rlimit none{3, old.rlim_max};
  ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &none), 0);
  for (int i = 0; i < 3; ++i) {
    node.settle();
    node.tcp.tick(TimePoint::clock::now() + std::chrono::seconds(i));
  }
  ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &old), 0);
  ASSERT_EQ(node.log.lines.size(), 2U);
  EXPECT_THAT(node.log.lines[1], HasSubstr("cannot accept connections"));
  EXPECT_EQ(node.tcp.size(), 1U);

  node.tcp.tick(TimePoint::clock::now() + std::chrono::seconds(10));
  node.settle();
  waiting.send(question(1));
  node.settle();
  EXPECT_THAT(waiting.received(), ElementsAreArray(answer_to(1)));
}

TEST(Accepting, The_loop_sleeps_for_ever_when_nobody_is_connected) {
  TcpUnderTest node;
  EXPECT_FALSE(node.tcp.patience().has_value());
  Client client = node.connect();
  EXPECT_TRUE(node.tcp.patience().has_value());
  client.vanish();
  node.settle();
  node.tcp.tick(TimePoint::clock::now() + std::chrono::seconds(1));
  EXPECT_FALSE(node.tcp.patience().has_value());
}

TEST(Stopping, A_signal_to_stop_is_seen_by_the_loop) {
  for (const int signal : {SIGINT, SIGTERM}) {
    Loop loop;
    Signals signals(loop);
    EXPECT_EQ(signals.stop(), 0);
    ::raise(signal);
    loop.run_once(std::chrono::milliseconds(1000));
    EXPECT_EQ(signals.stop(), signal);
    EXPECT_FALSE(signals.take_reload());
  }
}

TEST(Stopping, A_hangup_is_no_reason_to_stop_but_to_reload_once) {
  Loop loop;
  Signals signals(loop);
  ::raise(SIGHUP);
  loop.run_once(std::chrono::milliseconds(1000));
  EXPECT_EQ(signals.stop(), 0);
  EXPECT_TRUE(signals.take_reload());
  EXPECT_FALSE(signals.take_reload());
}

TEST(Stopping, A_terminal_that_is_closed_is_a_reason_to_stop) {
  int terminal = -1;
  const pid_t child = ::forkpty(&terminal, nullptr, nullptr, nullptr);
  ASSERT_GE(child, 0);
  if (child == 0) {
    Loop loop;
    Signals signals(loop);
    [[maybe_unused]] const ssize_t written = ::write(STDOUT_FILENO, "!", 1);
    for (int i = 0; i < 100 && signals.stop() == 0; ++i) loop.run_once(std::chrono::milliseconds(100));
    ::_exit(signals.stop() == SIGHUP && !signals.take_reload() ? 0 : 1);
  }
  char ready = 0;
  EXPECT_EQ(::read(terminal, &ready, 1), 1);
  ::close(terminal);
  int status = -1;
  EXPECT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_EQ(status, 0);
}

}  // namespace
}  // namespace coupler::node
