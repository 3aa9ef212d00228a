// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <pty.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>

#include "coupler/device/net/signals.hpp"
#include "test/device/net/tcp_under_test.hpp"

namespace coupler::device {
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

/// A server of three places whose coil 0 is an output.
struct ThreePlaces : testing::Test {
  ThreePlaces() { node.node.lines.outputs[0] = {}; }
  /// Of 127.0.0.`host`.
  Client asking(std::uint8_t host = 1) { return sending(question(1), host); }
  Client writing(std::uint8_t host = 1) { return sending(adu(1, pdu(5, {0, 0xFF00})), host); }
  Client sending(const Pdu& request, std::uint8_t host) {
    Client client = node.connect(host);
    client.send(request);
    node.settle();
    EXPECT_FALSE(client.received().empty());
    return client;
  }
  TcpUnderTest node{3};
};

TEST_F(ThreePlaces, Who_has_written_an_output_makes_room_last) {
  Client writer = writing();
  Client first = asking();
  Client second = asking();
  Client third = node.connect();
  EXPECT_TRUE(first.is_closed()) << "the longest idle of those that have written nothing";
  Client fourth = asking();
  EXPECT_TRUE(third.is_closed()) << "it never asked";
  Client fifth = writing();
  EXPECT_TRUE(second.is_closed());
  Client sixth = writing();
  EXPECT_TRUE(fourth.is_closed());
  EXPECT_FALSE(writer.is_closed());
  Client seventh = asking();
  EXPECT_TRUE(writer.is_closed()) << "all have written: the longest idle";
  EXPECT_FALSE(fifth.is_closed() || sixth.is_closed());
}

TEST_F(ThreePlaces, A_write_to_plain_memory_or_one_that_fails_is_no_write_to_an_output) {
  Client memory = sending(adu(1, pdu(5, {1, 0xFF00})), 1);
  node.node.lines.broken = true;
  Client failed = writing();
  node.node.lines.broken = false;
  Client writer = writing();
  Client next = writing();
  EXPECT_TRUE(memory.is_closed());
  Client last = writing();
  EXPECT_TRUE(failed.is_closed());
  EXPECT_FALSE(writer.is_closed());
}

TEST_F(ThreePlaces, A_flood_from_one_address_displaces_only_itself) {
  Client writer = writing(1);
  Client silent = node.connect(1);
  std::vector<Client> flood;
  for (int i = 0; i < 10; ++i) flood.push_back(writing(2));
  EXPECT_FALSE(writer.is_closed());
  EXPECT_FALSE(silent.is_closed()) << "although it never asked, and the others have written";
  EXPECT_FALSE(flood.back().is_closed());
  EXPECT_TRUE(flood[8].is_closed());
}

TEST_F(ThreePlaces, The_address_with_the_most_connections_makes_room_for_another) {
  Client oldest = asking(1);
  Client writer = writing(1);
  Client silent = node.connect(1);
  Client other = asking(2);
  EXPECT_TRUE(silent.is_closed());
  Client second = asking(2);
  EXPECT_TRUE(other.is_closed()) << "with it, both have two: the newcomer's address makes room";
  EXPECT_FALSE(oldest.is_closed() || writer.is_closed());
  Client third = asking(3);
  EXPECT_TRUE(oldest.is_closed());
  Client fourth = asking(4);
  EXPECT_TRUE(second.is_closed()) << "one each: who has written stays";
  EXPECT_FALSE(writer.is_closed());
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
  EXPECT_FALSE(node.tcp.time_until_due(TimePoint::clock::now()).has_value());
  Client client = node.connect();
  EXPECT_TRUE(node.tcp.time_until_due(TimePoint::clock::now()).has_value());
  client.vanish();
  node.settle();
  node.tcp.tick(TimePoint::clock::now() + std::chrono::seconds(1));
  EXPECT_FALSE(node.tcp.time_until_due(TimePoint::clock::now()).has_value());
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
}  // namespace coupler::device
