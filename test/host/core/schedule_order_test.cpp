// SPDX-License-Identifier: Apache-2.0
// Outputs at a time: what is asked for one after the other happens at the node one after the other.
#include <gtest/gtest.h>

#include "coupler/host/core/node_outputs.hpp"
#include "test/host/core/fake_clock.hpp"

namespace coupler::host {
namespace {

using modbus::NodeTime;
using std::chrono::hours;
using std::chrono::microseconds;
using std::chrono::milliseconds;
using std::chrono::seconds;

struct IgnoredChanges final : ChangeSink {
  void on_change(const modbus::Change&, std::uint64_t, Stamp) override {}
  void on_gap() override {}
  void on_heard(std::uint64_t, std::optional<Stamp>) override {}
  void on_end() override {}
  Time answer_wanted() override { return Time::max(); }
};

struct IgnoredOutcomes final : ScheduledListener {
  void on_outcome(const AcceptedWrite&, ScheduledOutcome::Result, Stamp, const std::string&) override {}
};

/// The node's clock is an hour behind.
struct ScheduleOrderTest : testing::Test {
  ScheduleOrderTest() { exchange(milliseconds(2), milliseconds(8)); }

  void exchange(Duration there, Duration back) {
    const Time sent = clock.now();
    const NodeTime arrived = sent.time_since_epoch() + there - behind;
    clock.advance(there + back);
    mapping.add({sent, arrived, arrived, clock.now()});
  }
  NodeTime accept(Time due) {
    const NodeTime at = outputs.node_due(due, mapping).value();
    AcceptedWrite what;
    what.what.due = due;
    outputs.add(++number, at, what);
    return at;
  }

  test::FakeClock clock;
  NodeTime behind = hours(1);
  ClockMapping mapping;
  IgnoredChanges changes;
  IgnoredOutcomes outcomes;
  NodeOutputs outputs{changes, clock, outcomes};
  std::uint16_t number = 0;
};

TEST_F(ScheduleOrderTest, The_same_time_is_the_same_for_the_node_although_the_mapping_moves) {
  const Time due = clock.now() + seconds(1);
  const NodeTime first = accept(due);
  for (const auto back : {milliseconds(4), milliseconds(3), milliseconds(1)}) {
    exchange(milliseconds(1), back);
    EXPECT_EQ(accept(due), first);
  }
  EXPECT_NE(mapping.node_time(due), first);
}

TEST_F(ScheduleOrderTest, What_is_due_earlier_or_later_stays_so) {
  const Time due = clock.now() + seconds(1);
  const NodeTime first = accept(due);
  exchange(milliseconds(0), milliseconds(1));  // what was mapped before was too early
  EXPECT_GT(mapping.node_time(due - microseconds(10)), first);
  EXPECT_LE(accept(due - microseconds(10)), first);
  EXPECT_GE(accept(due + microseconds(10)), first);
}

TEST_F(ScheduleOrderTest, What_is_not_close_is_mapped_as_well_as_is_known) {
  const Time due = clock.now() + seconds(1);
  accept(due);
  exchange(milliseconds(0), milliseconds(1));
  for (const Time other : {due - milliseconds(100), due + milliseconds(100)})
    EXPECT_EQ(outputs.node_due(other, mapping), mapping.node_time(other));
}

TEST_F(ScheduleOrderTest, A_clock_that_has_jumped_says_nothing_of_what_was_asked_before) {
  const Time due = clock.now() + seconds(5);
  accept(due);
  behind += seconds(30);
  exchange(milliseconds(1), milliseconds(1));
  EXPECT_EQ(outputs.node_due(due, mapping), mapping.node_time(due));
}

}  // namespace
}  // namespace coupler::host
