// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>

#include "test/host/core/changes_fixture.hpp"

namespace coupler::host {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using test::cell;
using test::ChangesTest;
using test::Publish;
using testing::Each;
using testing::ElementsAre;

TEST_F(ChangesTest, A_point_on_change_is_read_once_and_then_heard_of) {
  device.values[{Table::discrete_inputs, 3}] = 1;
  begin(cell());
  EXPECT_THAT(sink->values["barrier"], ElementsAre(1));
  device.change(Table::discrete_inputs, 3, false);
  run_for(milliseconds(1));
  EXPECT_THAT(sink->values["barrier"], ElementsAre(1, 0));
  run_for(seconds(10));
  EXPECT_THAT(sink->values["barrier"], ElementsAre(1, 0));
  EXPECT_EQ(reads(), 0U);
}

TEST_F(ChangesTest, An_idle_coupler_is_asked_once_a_second) {
  begin(cell());
  run_for(seconds(20));
  EXPECT_EQ(reads(), 0U);
  EXPECT_GE(waits(), 19U);
  EXPECT_LE(waits(), 21U);
  EXPECT_THAT(sink->online, ElementsAre(true));
}

TEST_F(ChangesTest, Changes_come_in_order_however_many_there_are) {
  begin(cell());
  std::vector<std::uint16_t> expected{0};
  for (int i = 0; i < 60; ++i) {
    device.change(Table::discrete_inputs, 3, i % 2 == 0);
    expected.push_back(i % 2 == 0 ? 1 : 0);
  }
  run_for(milliseconds(1));
  EXPECT_EQ(sink->values["barrier"], expected);
  EXPECT_EQ(engine->statistics().changes, 60U);
}

TEST_F(ChangesTest, The_stamp_is_the_time_of_the_change) {
  begin(cell());
  run_for(milliseconds(300));
  const Time edge = clock.now();
  device.change(Table::discrete_inputs, 3, true);
  clock.advance(milliseconds(40));
  run_for(milliseconds(1));
  const Stamp stamp = sink->stamps.back();
  EXPECT_LE(std::chrono::abs(stamp.at - edge), stamp.uncertainty);
  EXPECT_LT(stamp.uncertainty, milliseconds(30));
}

TEST_F(ChangesTest, A_change_whose_time_makes_no_sense_came_after_the_answer_before) {
  begin(cell());
  run_for(milliseconds(2500));
  clock.sleep_until(device.answers_wait_at());
  engine->arrived();
  const Time edge = clock.now();
  device.change(Table::discrete_inputs, 3, true);
  device.changes.back().at = modbus::NodeTime(-1);
  clock.advance(milliseconds(5));
  engine->step();  // the next wait
  engine->arrived();
  const Stamp stamp = sink->stamps.back();
  EXPECT_LE(std::chrono::abs(stamp.at - edge), stamp.uncertainty);
  EXPECT_LE(stamp.uncertainty, milliseconds(1100));
}

TEST_F(ChangesTest, What_is_published_always_is_polled_and_heard_of) {
  begin(fakes::MapBuilder().input("barrier", 3));
  sink->values.clear();
  device.change(Table::discrete_inputs, 3, true);
  run_for(milliseconds(1));
  EXPECT_THAT(sink->values["barrier"], ElementsAre(1)) << "before the next poll";
  run_for(milliseconds(350));
  EXPECT_GE(sink->values["barrier"].size(), 4U);
  EXPECT_THAT(sink->values["barrier"], Each(1));
}

TEST_F(ChangesTest, A_poll_goes_out_only_while_a_wait_is_outstanding) {
  begin(fakes::MapBuilder().input("barrier", 3));
  run_for(seconds(1));
  std::size_t outstanding = 1;
  for (const std::string& request : device.requests) {
    if (request.rfind("wait", 0) == 0)
      outstanding = 1;
    else
      EXPECT_EQ(std::exchange(outstanding, 0), 1U) << request;
  }
}

TEST_F(ChangesTest, Changes_that_are_older_than_a_poll_all_come_and_before_its_value) {
  begin(fakes::MapBuilder().input("barrier", 3));
  run_for(milliseconds(85));  // the next poll is near
  std::vector<int> levels;
  for (int i = 0; i < 41; ++i) {
    levels.push_back(i % 2 == 0 ? 1 : 0);
    device.change(Table::discrete_inputs, 3, i % 2 == 0);
  }
  sink->values.clear();
  clock.advance(milliseconds(20));
  engine->step();  // the poll: its wait tells of 18 changes, and the value is newer than all 41
  EXPECT_EQ(sink->values["barrier"].size(), 18U);
  run_for(milliseconds(20));
  EXPECT_THAT(sink->values["barrier"], testing::ElementsAreArray(levels));
}

TEST_F(ChangesTest, What_stays_as_it_is_is_published_while_changes_of_others_follow) {
  begin(fakes::MapBuilder().input("barrier", 3).input("door", 4));
  run_for(milliseconds(85));  // the next poll is near
  for (int i = 0; i < 41; ++i) device.change(Table::discrete_inputs, 3, i % 2 == 0);
  sink->values.clear();
  clock.advance(milliseconds(20));
  engine->step();  // the poll: its wait tells of 18 changes
  EXPECT_EQ(sink->values["barrier"].size(), 18U);
  EXPECT_THAT(sink->values["door"], ElementsAre(0));
}

TEST_F(ChangesTest,
       Someone_who_begins_to_listen_while_more_changes_follow_gets_the_value_that_is_read_after_them) {
  begin(cell());
  for (int i = 0; i < 41; ++i) device.change(Table::discrete_inputs, 3, i % 2 == 0);
  engine->want(barrier(), true);
  sink->values.clear();
  run_for(milliseconds(200));
  ASSERT_GE(sink->values["barrier"].size(), 42U);
  EXPECT_EQ(sink->values["barrier"].back(), 1);
  EXPECT_LE(reads(), 3U) << "no more than one while changes follow, unless it was shown";
}

TEST_F(ChangesTest, After_lost_changes_a_value_counts_though_older_changes_follow) {
  begin(cell());
  for (int i = 0; i < 60; ++i) device.change(Table::discrete_inputs, 3, i % 2 == 0);
  device.forgotten = 10;
  sink->values.clear();
  run_for(milliseconds(200));
  ASSERT_FALSE(sink->values["barrier"].empty());
  EXPECT_THAT(sink->values["barrier"], Each(0));
}

TEST_F(ChangesTest, After_lost_changes_everything_is_read_once) {
  begin(cell());
  for (int i = 0; i < 30; ++i) device.change(Table::discrete_inputs, 3, i % 2 == 0);
  device.change(Table::coils, 5, true);
  device.forgotten = 31;
  run_for(milliseconds(10));
  EXPECT_EQ(sink->values["lamp"].back(), 1);
  EXPECT_EQ(sink->values["barrier"].back(), 0);
  EXPECT_EQ(reads(), 2U);
  EXPECT_EQ(engine->statistics().changes_lost, 31U);
  run_for(seconds(5));
  EXPECT_EQ(reads(), 2U);
}

TEST_F(ChangesTest, After_a_new_epoch_everything_is_read_once) {
  begin(cell());
  device.epoch = 77;
  device.values[{Table::coils, 5}] = 1;
  run_for(seconds(3));
  EXPECT_EQ(sink->values["lamp"].back(), 1);
  EXPECT_EQ(device.count("read coils 5+1") + device.count("read discrete_inputs 3+1"), 2U);
  EXPECT_EQ(sink->reported("count of changes starts again"), 1);
}

TEST_F(ChangesTest, In_a_new_epoch_the_node_may_have_another_clock) {
  begin(cell());
  run_for(seconds(1));
  device.epoch = 77;
  device.changes.clear();
  device.clock_is_ahead = seconds(1);
  run_for(seconds(3));
  const Time edge = clock.now();
  device.change(Table::discrete_inputs, 3, true);
  run_for(milliseconds(1));
  const Stamp stamp = sink->stamps.back();
  EXPECT_LE(std::chrono::abs(stamp.at - edge), stamp.uncertainty);
  EXPECT_EQ(sink->reported("has jumped"), 0);
}

TEST_F(ChangesTest, Stamps_of_a_point_do_not_go_back) {
  begin(cell());
  run_for(milliseconds(300));
  const Time before = clock.now() - milliseconds(20);
  device.change(Table::discrete_inputs, 3, true);
  run_for(milliseconds(1));
  const Stamp first = sink->stamps.back();
  device.change(Table::discrete_inputs, 3, false);
  device.changes.back().at = device.changes.front().at - milliseconds(20);
  run_for(milliseconds(1));
  const Stamp second = sink->stamps.back();
  EXPECT_EQ(second.at, first.at);
  EXPECT_GE(second.uncertainty, second.at - before);
}

TEST_F(ChangesTest, In_a_new_epoch_the_the_node_may_have_another_watchdog_and_is_asked) {
  begin(cell());
  run_for(seconds(2));
  device.tell_changes(300);
  device.epoch = 77;
  run_for(seconds(2));
  device.requests.clear();
  run_for(seconds(1));
  EXPECT_EQ(waits(), 0U);
  EXPECT_GE(device.count("wait 100"), 9U);
  EXPECT_THAT(sink->online, ElementsAre(true));
}

TEST_F(ChangesTest, A_node_that_falls_silent_is_offline_after_the_wait_and_a_timeout) {
  begin(cell());
  run_for(seconds(1));
  device.ignores_waits = true;
  device.refuse_connect = NotConnected{"refused"};
  run_for(milliseconds(2900));
  EXPECT_THAT(sink->online, ElementsAre(true));
  run_for(seconds(2));
  EXPECT_THAT(sink->online, ElementsAre(true, false));
}

TEST_F(ChangesTest, The_wait_is_a_third_of_the_nodes_watchdog) {
  begin(cell(), 600);
  run_for(seconds(1));
  EXPECT_GE(device.count("wait 200"), 4U);
  EXPECT_EQ(waits(), 0U);
}

TEST_F(ChangesTest, The_wait_is_no_longer_than_the_timeout) {
  MapBuilder builder = cell();
  builder.head().connection.timeout = milliseconds(250);
  begin(builder);
  run_for(seconds(1));
  EXPECT_GE(device.count("wait 250"), 3U);
}

TEST_F(ChangesTest, A_change_before_a_write_is_hidden_and_the_point_read_again) {
  begin(cell());
  device.change(Table::coils, 5, true);
  device.refuses = [](const std::string& request) {
    return request == "write coil 5" ? std::optional(modbus::Exception::server_device_failure) : std::nullopt;
  };
  push("lamp", 0);
  engine->step();  // the wait's answer tells the change, and then the write is refused
  EXPECT_THAT(sink->values["lamp"], ElementsAre(0))
      << "an older value is not shown while a newer one is on its way";
  run_for(milliseconds(200));
  EXPECT_THAT(sink->values["lamp"], ElementsAre(0, 1));
}

TEST_F(ChangesTest, A_told_point_does_not_become_stale) {
  begin(cell());
  run_for(seconds(60));
  EXPECT_EQ(table->quality(barrier(), clock.now()).state, PointQuality::State::good);
  EXPECT_LE(clock.now() - *table->quality(barrier(), clock.now()).last_good, seconds(2));
}

TEST_F(ChangesTest, When_the_node_is_gone_a_value_is_as_old_as_what_was_heard_last) {
  begin(cell());
  run_for(seconds(60));
  device.ignores_waits = true;
  device.refuse_connect = NotConnected{"unplugged"};
  run_for(seconds(10));
  EXPECT_EQ(table->quality(barrier(), clock.now()).state, PointQuality::State::offline);
  EXPECT_LE(clock.now() - *table->quality(barrier(), clock.now()).last_good, seconds(12));
}

TEST_F(ChangesTest, When_a_point_is_told_no_more_its_value_is_as_old_as_what_was_heard_last) {
  begin(cell());
  run_for(seconds(60));
  engine->want(barrier(), false);
  EXPECT_EQ(table->quality(barrier(), clock.now()).state, PointQuality::State::good);
  EXPECT_LE(clock.now() - *table->quality(barrier(), clock.now()).last_good, seconds(2));
  run_for(seconds(10));
  EXPECT_EQ(table->quality(barrier(), clock.now()).state, PointQuality::State::stale);
}

TEST_F(ChangesTest, Who_begins_to_listen_gets_a_value_that_is_read_now) {
  begin(cell());
  engine->want(barrier(), true);  // again
  run_for(milliseconds(1));
  EXPECT_EQ(reads(), 1U);
  EXPECT_EQ(sink->values["barrier"].size(), 2U);
}

TEST_F(ChangesTest, Changes_of_points_that_nobody_wants_are_dropped) {
  begin(cell());
  engine->want(barrier(), false);
  device.change(Table::discrete_inputs, 3, true);
  run_for(seconds(1));
  EXPECT_EQ(sink->values["barrier"].size(), 1U);
  engine->want(barrier(), true);
  run_for(milliseconds(1));
  EXPECT_THAT(sink->values["barrier"], ElementsAre(0, 1));
}

TEST_F(ChangesTest, Changes_at_addresses_that_the_map_does_not_have_are_ignored) {
  begin(cell());
  device.change(Table::discrete_inputs, 200, true);
  run_for(milliseconds(1));
  EXPECT_EQ(sink->values["barrier"].size(), 1U);
  EXPECT_EQ(engine->statistics().changes, 1U);
}

}  // namespace
}  // namespace coupler::host
