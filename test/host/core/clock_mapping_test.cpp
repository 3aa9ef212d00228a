// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/core/clock_mapping.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <random>

namespace coupler::host {
namespace {

using modbus::NodeTime;
using std::chrono::microseconds;
using std::chrono::milliseconds;
using std::chrono::nanoseconds;
using std::chrono::seconds;
using Outcome = ClockMapping::Outcome;

/// A node whose clock has an offset and a drift that wanders, and a network that delays.
class World {
 public:
  World(unsigned seed, double drift, double wander)
      : random_(seed), mean_(drift), drift_(drift), wander_(wander) {
    node_ = NodeTime(between(0, 1'000'000'000'000'000));
  }

  void pass(nanoseconds time) {
    ours_ += time;
    rest_ += static_cast<double>(time.count()) * (1 + drift_);
    const auto whole = static_cast<std::int64_t>(rest_);
    rest_ -= static_cast<double>(whole);
    node_ += NodeTime(whole);
    if (between(0, 4) == 0) drift_ = mean_ + wander_ * static_cast<double>(between(-100, 100)) / 100;
  }
  Exchange exchange(nanoseconds wait) {
    Exchange made;
    made.sent = ours_;
    pass(delay());
    made.arrived = node_;
    pass(wait);
    made.replied = node_;
    pass(delay());
    made.received = ours_;
    return made;
  }
  std::int64_t between(std::int64_t least, std::int64_t most) {
    return std::uniform_int_distribution<std::int64_t>(least, most)(random_);
  }
  /// Mostly short, now and then long, and longer in one direction or the other.
  nanoseconds delay() {
    return microseconds(between(0, 9) == 0 ? between(1'000, 200'000) : between(20, 400));
  }
  Time ours() const { return ours_; }
  NodeTime node() const { return node_; }
  void jump(NodeTime by) { node_ += by; }

 private:
  std::mt19937 random_;
  double mean_;
  double drift_;
  double wander_;
  Time ours_ = Time{} + std::chrono::hours(5);
  NodeTime node_{};
  double rest_ = 0;  ///< of a nanosecond
};

TEST(ClockMapping, A_time_of_ours_is_the_nodes_time_that_is_mapped_to_it) {
  EXPECT_FALSE(ClockMapping().node_time(Time{} + seconds(5)));
  for (unsigned seed = 0; seed < 10; ++seed) {
    World world(seed, 300e-6, 0);
    ClockMapping mapping;
    for (int i = 0; i < 30; ++i) {
      mapping.add(world.exchange(seconds(1)));
      for (const nanoseconds ahead : {nanoseconds(0), nanoseconds(seconds(3)), nanoseconds(seconds(3600))}) {
        const auto node = mapping.node_time(world.ours() + ahead);
        ASSERT_TRUE(node);
        const auto back = mapping.map(*node);
        ASSERT_TRUE(back);
        EXPECT_LE(std::chrono::abs(back->at - (world.ours() + ahead)), nanoseconds(3));
      }
    }
  }
}

TEST(ClockMapping, The_true_time_is_always_inside_the_stated_uncertainty) {
  for (unsigned seed = 0; seed < 60; ++seed) {
    const double drift = (static_cast<double>(seed % 9) - 4) * 110e-6;
    World world(seed, drift, seed % 2 == 0 ? 0 : ClockMapping::most_wander / 4);
    ClockMapping mapping;
    for (int i = 0; i < 400; ++i) {
      const Time before = world.ours();
      const NodeTime node_before = world.node();
      const auto wait = milliseconds(world.between(0, 1000));
      const auto outcome = mapping.add(world.exchange(wait));
      ASSERT_EQ(outcome, Outcome::taken) << seed << ", " << i;
      for (const auto& [ours, node] :
           {std::pair(before, node_before), std::pair(world.ours(), world.node())}) {
        const auto stamp = mapping.map(node);
        ASSERT_TRUE(stamp);
        ASSERT_LE(std::chrono::abs(stamp->at - ours), stamp->uncertainty + nanoseconds(2))
            << seed << ", " << i;
      }
      world.pass(milliseconds(world.between(0, 200)));
    }
  }
}

TEST(ClockMapping, One_exchange_is_known_to_half_of_what_the_network_took) {
  ClockMapping mapping;
  const Time sent = Time{} + seconds(100);
  mapping.add({sent, NodeTime(5000), NodeTime(6000), sent + nanoseconds(1400)});
  const auto stamp = mapping.map(NodeTime(6000));
  ASSERT_TRUE(stamp);
  EXPECT_LE(stamp->uncertainty, nanoseconds(203));
  EXPECT_GE(stamp->uncertainty, nanoseconds(200));
}

TEST(ClockMapping, A_jump_is_seen_at_the_arrival_of_a_request_that_waits_long) {
  ClockMapping mapping;
  const Time sent = Time{} + seconds(100);
  mapping.add({sent, NodeTime(0), NodeTime(0), sent + milliseconds(1)});
  // The offset is 20 ms now. After ten seconds it can be 6 ms; after 40 it could be 21 ms.
  const Time again = sent + seconds(10) + milliseconds(20);
  const NodeTime arrived = seconds(10);
  EXPECT_EQ(mapping.add({again, arrived, arrived + seconds(30), again + seconds(30) + milliseconds(1)}),
            Outcome::jumped);
  const auto stamp = mapping.map(arrived);
  ASSERT_TRUE(stamp);
  EXPECT_GE(stamp->uncertainty, nanoseconds(0));
  EXPECT_LE(std::chrono::abs(stamp->at - again), stamp->uncertainty);
}

TEST(ClockMapping, A_clock_that_counts_milliseconds_does_not_jump) {
  World world(7, 0, 0);
  ClockMapping mapping;
  const auto ticks = [](NodeTime at) { return std::chrono::floor<milliseconds>(at); };
  for (int i = 0; i < 400; ++i) {
    Exchange told = world.exchange(milliseconds(1000));
    told.arrived = ticks(told.arrived);
    told.replied = ticks(told.replied);
    ASSERT_EQ(mapping.add(told), Outcome::taken) << i;
    const auto stamp = mapping.map(told.arrived);
    ASSERT_TRUE(stamp);
    EXPECT_GE(stamp->uncertainty, nanoseconds(0));
    EXPECT_LE(std::chrono::abs(stamp->at - told.sent), milliseconds(201));  // at most what the network takes
    world.pass(microseconds(50));
  }
}

TEST(ClockMapping, A_long_exchange_does_not_spoil_what_a_short_one_told) {
  World world(1, 0, 0);
  ClockMapping mapping;
  Exchange exchange = world.exchange(nanoseconds(0));
  exchange.sent = world.ours() - microseconds(100);
  exchange.arrived = exchange.replied = world.node() - microseconds(50);
  mapping.add(exchange);
  exchange.sent -= milliseconds(300);
  EXPECT_EQ(mapping.add(exchange), Outcome::taken);
  EXPECT_LE(mapping.map(world.node())->uncertainty, microseconds(51));
}

TEST(ClockMapping, The_drift_is_learned_so_that_uncertainty_grows_slowly) {
  World world(2, 300e-6, 0);
  ClockMapping mapping;
  for (int i = 0; i < 60; ++i) mapping.add(world.exchange(seconds(1)));
  const auto now = mapping.map(world.node())->uncertainty;
  const auto later = mapping.map(world.node() + seconds(10))->uncertainty;
  EXPECT_LT(later - now, milliseconds(1));  // 5 ms at the drift that is possible at first
}

TEST(ClockMapping, A_jump_of_a_clock_begins_anew) {
  World world(3, 0, 0);
  ClockMapping mapping;
  for (const NodeTime by : {NodeTime(seconds(2)), NodeTime(-seconds(2))}) {
    mapping.add(world.exchange(milliseconds(10)));
    world.jump(by);
    EXPECT_EQ(mapping.add(world.exchange(milliseconds(10))), Outcome::jumped);
    const auto stamp = mapping.map(world.node());
    ASSERT_TRUE(stamp);
    EXPECT_LE(std::chrono::abs(stamp->at - world.ours()), stamp->uncertainty);
  }
}

TEST(ClockMapping, Times_that_no_clock_has_are_refused) {
  const Time sent = Time{} + seconds(100);
  const Exchange possible{sent, NodeTime(10), NodeTime(20), sent + nanoseconds(15)};
  Exchange backwards = possible;
  backwards.replied = NodeTime(9);
  Exchange too_long = possible;  // it took the node longer than us
  too_long.replied = NodeTime(seconds(1));
  Exchange huge = possible;
  huge.arrived = huge.replied = NodeTime::max();
  Exchange negative = possible;
  negative.arrived = NodeTime::min();
  for (const Exchange& wrong : {backwards, too_long, huge, negative}) {
    ClockMapping mapping;
    EXPECT_EQ(mapping.add(possible), Outcome::taken);
    EXPECT_EQ(mapping.add(wrong), Outcome::refused);
    EXPECT_FALSE(mapping.map(NodeTime(15)));
    EXPECT_EQ(mapping.add(possible), Outcome::taken);
    EXPECT_FALSE(mapping.map(NodeTime::max()));
    EXPECT_FALSE(mapping.map(NodeTime::min()));
  }
}

}  // namespace
}  // namespace coupler::host
