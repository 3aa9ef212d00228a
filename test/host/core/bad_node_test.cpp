// SPDX-License-Identifier: Apache-2.0
// A node that tells changes, but not as it should, or a gateway before it that does not let them through.
#include <gmock/gmock.h>

#include <algorithm>
#include <vector>

#include "test/host/core/changes_fixture.hpp"

namespace coupler::host {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;
using std::chrono::seconds;
using test::cell;
using test::ChangesTest;
using testing::Each;
using testing::ElementsAre;
using testing::Le;

struct BadNodeTest : ChangesTest {
  /// Every request takes some time; those that wait are noted.
  void watch() {
    device.during_wait = [this] {
      clock.advance(microseconds(100));
      asked.push_back(clock.now());
    };
    device.during_read = [this] { clock.advance(microseconds(100)); };
  }
  /// Between one wait and the next.
  Duration longest_pause() const {
    Duration longest{};
    for (std::size_t i = 1; i < asked.size(); ++i) longest = std::max(longest, asked[i] - asked[i - 1]);
    return longest;
  }
  std::vector<Time> asked;
};

TEST_F(BadNodeTest, Epochs_without_end_are_asked_for_less_and_less_often) {
  watch();
  device.begins_epochs = true;
  begin(cell());
  run_for(seconds(20));
  EXPECT_LE(reads(), 100U) << "identity and both points, each time";
  EXPECT_LE(sink->reported("count of changes starts again"), 21) << "a line a second";
  EXPECT_THAT(longest_pause(), Le(milliseconds(1010)));
  EXPECT_THAT(sink->online, ElementsAre(true));
}

TEST_F(BadNodeTest, A_node_with_a_watchdog_is_asked_as_often_as_that_needs) {
  watch();
  device.begins_epochs = true;
  begin(cell(), 300);
  run_for(seconds(20));
  EXPECT_THAT(longest_pause(), Le(milliseconds(110)));
}

TEST_F(BadNodeTest, A_watchdog_that_no_map_can_have_does_not_end_the_pauses) {
  watch();
  device.begins_epochs = true;
  begin(cell(), 1);
  run_for(seconds(2));
  EXPECT_LE(asked.size(), 700U) << "one in three milliseconds";
}

TEST_F(BadNodeTest, Losses_without_end_do_not_mean_reading_without_end) {
  watch();
  begin(cell());
  device.during_wait = [this] {
    clock.advance(microseconds(100));
    device.change(Table::coils, 5, true);
    device.forgotten = device.changes.size();
  };
  run_for(seconds(2));  // the first of them with the answer to a wait
  EXPECT_LE(reads(), 110U) << "one in ten milliseconds";
  EXPECT_GE(reads(), 90U) << "changes may be lost at a good node, too, where an input bounces";
}

TEST_F(BadNodeTest, A_node_that_counts_changes_and_tells_none_is_read_less_and_less_often) {
  watch();
  begin(cell());
  device.holds_changes_back = true;
  run_for(seconds(20));
  EXPECT_LE(reads(), 100U) << "identity and both points, each time";
  EXPECT_LE(asked.size(), 60U);
  device.values[{Table::coils, 5}] = 1;
  run_for(seconds(2));
  EXPECT_EQ(sink->values["lamp"].back(), 1);
}

TEST_F(BadNodeTest, Answers_that_bring_nothing_are_not_asked_for_at_once) {
  watch();
  begin(cell());
  device.answers_waits_early = true;
  run_for(seconds(1));
  EXPECT_LE(waits(), 102U);
  device.change(Table::coils, 5, true);
  run_for(milliseconds(11));
  EXPECT_THAT(sink->values["lamp"], ElementsAre(0, 1));
}

TEST_F(BadNodeTest, A_write_does_not_wait_for_the_end_of_a_pause) {
  watch();
  device.begins_epochs = true;
  begin(cell());
  run_for(seconds(20));
  push("lamp", 1);
  engine->step();
  EXPECT_EQ(device.count("write coil 5"), 1U);
}

TEST_F(BadNodeTest, In_a_pause_nothing_is_polled) {
  watch();
  device.begins_epochs = true;
  begin(fakes::MapBuilder().input("barrier", 3));
  run_for(seconds(20));
  std::size_t outstanding = 0;
  for (const std::string& request : device.requests) {
    if (request.rfind("wait", 0) == 0) outstanding = 1;
    if (request.rfind("read discrete_inputs", 0) == 0) {
      EXPECT_EQ(std::exchange(outstanding, 0), 1U);
    }
  }
}

TEST_F(BadNodeTest, One_new_epoch_costs_no_pause) {
  begin(cell());
  for (std::uint16_t value = 1; value < 4; ++value) {
    run_for(seconds(20));
    engine->step();
    device.values[{Table::coils, 5}] = value % 2;
    ++device.epoch;
    engine->arrived();
    for (int i = 0; i < 6; ++i) engine->step();
    EXPECT_EQ(sink->values["lamp"].back(), value % 2);
  }
}

TEST_F(BadNodeTest, While_a_node_is_silent_it_is_looked_after_what_was_sent_meanwhile) {
  begin(cell());
  device.ignores_waits = true;
  for (int i = 0; i < 5; ++i) {
    EXPECT_LE(engine->step(), clock.now() + seconds(3)) << "the timeout: a write may be sent now";
    clock.advance(milliseconds(500));
  }
}

TEST_F(BadNodeTest, Where_a_gateway_refuses_the_wait_everything_is_polled) {
  for (const auto code : {modbus::Exception::illegal_function, modbus::Exception::gateway_path_unavailable,
                          modbus::Exception::gateway_target_failed_to_respond}) {
    engine.reset();
    device.refuses_waits = code;
    begin(cell());
    run_for(seconds(1));
    EXPECT_GE(reads(), 18U) << "two requests ten times a second";
    EXPECT_THAT(sink->online, ElementsAre(true));
    EXPECT_EQ(sink->reported("polled while this connection lasts"), 1);
  }
}

TEST_F(BadNodeTest, Where_a_gateway_drops_the_wait_everything_is_polled_after_two_connections) {
  device.drops_waits = true;
  begin(cell());
  run_for(seconds(1));
  device.requests.clear();
  run_for(seconds(60));
  EXPECT_GE(reads(), 60U * 18);
  EXPECT_EQ(device.count("connect"), 0U);
  EXPECT_THAT(sink->online, ElementsAre(true, false, true));
  EXPECT_EQ(sink->reported("polled while this connection lasts"), 1);
}

TEST_F(BadNodeTest, Where_a_gateway_dropped_the_wait_it_is_tried_again_after_the_next_loss) {
  device.drops_waits = true;
  begin(cell());
  run_for(seconds(1));
  device.drops_waits = false;
  device.next_errors.emplace_back(TransportFailure{"the device closed the connection"});
  run_for(seconds(1));
  device.requests.clear();
  run_for(seconds(10));
  EXPECT_EQ(reads(), 0U);
  EXPECT_GE(waits(), 9U);
}

TEST_F(BadNodeTest, A_connection_that_ends_before_the_first_answer_may_do_so_by_chance) {
  device.drops_waits = true;
  begin(cell());
  ASSERT_THAT(sink->online, ElementsAre(true, false));
  device.drops_waits = false;
  run_for(seconds(1));
  device.requests.clear();
  run_for(seconds(10));
  EXPECT_EQ(reads(), 0U);
  EXPECT_EQ(sink->reported("polled while this connection lasts"), 0);
}

TEST_F(BadNodeTest, A_node_that_has_told_changes_and_falls_silent_is_asked_for_them_again) {
  begin(cell());
  run_for(seconds(2));
  device.ignores_waits = true;
  device.refuse_connect = NotConnected{"refused"};
  run_for(seconds(5));
  EXPECT_THAT(sink->online, ElementsAre(true, false));
  device.ignores_waits = false;
  device.refuse_connect.reset();
  run_for(seconds(2));
  device.requests.clear();
  run_for(seconds(10));
  EXPECT_EQ(reads(), 0U);
}

}  // namespace
}  // namespace coupler::host
