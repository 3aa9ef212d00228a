// SPDX-License-Identifier: Apache-2.0
// Which points of a device that tells changes are polled, and what of arrays is shown.
#include <chrono>

#include <gmock/gmock.h>

#include "test/host/core/changes_fixture.hpp"

namespace coupler::host {
namespace {

using fakes::MapBuilder;
using std::chrono::milliseconds;
using std::chrono::seconds;
using test::cell;
using test::ChangesTest;
using test::Publish;
using test::RecordingSink;
using testing::Each;
using testing::ElementsAre;
using testing::StartsWith;

/// Eight inputs, an array.
MapBuilder row() {
  MapBuilder builder;
  builder.add(Table::discrete_inputs, "row", 8, codec::Type::BOOL, [](Point& point) {
    point.count = 4;
    point.host.publish = Publish::on_change;
  });
  return builder;
}

/// With four lights, an array.
MapBuilder cell_with_lights() {
  MapBuilder builder = cell();
  builder.add(Table::coils, "lights", 20, codec::Type::BOOL, [](Point& point) {
    point.count = 4;
    point.host.publish = Publish::on_change;
  });
  return builder;
}

TEST_F(ChangesTest, An_array_whose_bits_change_in_one_step_is_shown_once) {
  begin(row());
  device.change(Table::discrete_inputs, 10, true);
  device.change(Table::discrete_inputs, 8, true);
  run_for(milliseconds(1));
  EXPECT_THAT(sink->values["row"], ElementsAre(0, 1)) << "the first of four";
}

TEST_F(ChangesTest, An_array_whose_bits_change_in_two_steps_is_shown_twice) {
  begin(row());
  device.change(Table::discrete_inputs, 8, true);
  device.changes.back().at -= std::chrono::microseconds(1);
  device.change(Table::discrete_inputs, 8, false);
  run_for(milliseconds(1));
  EXPECT_THAT(sink->values["row"], ElementsAre(0, 1, 0));
}

TEST_F(ChangesTest, A_node_that_refuses_after_all_is_polled) {
  device.refuses_waits = modbus::Exception::illegal_function;
  begin(cell());
  run_for(seconds(1));
  EXPECT_GE(reads(), 18U) << "two requests ten times a second";
  EXPECT_EQ(sink->reported("polled while this connection lasts"), 1);
  EXPECT_THAT(sink->online, ElementsAre(true));
}

TEST_F(ChangesTest, However_many_changes_are_older_than_a_write_none_comes_after_it) {
  begin(cell());
  sink->values.clear();
  for (int i = 0; i < 40; ++i) device.change(Table::coils, 5, i % 2 == 0);
  push("lamp", 1);
  engine->step();  // the wait's answer has 18 of them
  device.change(Table::coils, 5, true);
  run_for(milliseconds(20));
  ASSERT_FALSE(sink->values["lamp"].empty());
  EXPECT_THAT(sink->values["lamp"], Each(1));
}

TEST_F(ChangesTest, What_was_left_out_for_a_write_that_fails_is_read) {
  begin(cell());
  for (int i = 0; i < 18; ++i) device.change(Table::discrete_inputs, 3, i % 2 == 0);
  device.change(Table::coils, 5, true);  // the nineteenth
  device.refuses = [](const std::string& request) {
    return request == "write coil 5" ? std::optional(modbus::Exception::server_device_failure) : std::nullopt;
  };
  push("lamp", 0);
  engine->step();
  run_for(milliseconds(200));
  EXPECT_THAT(sink->values["lamp"], ElementsAre(0, 1));
}

TEST_F(ChangesTest, An_array_of_which_a_change_was_left_out_is_not_shown_before_it_is_read) {
  begin(cell_with_lights());
  for (int i = 0; i < 18; ++i) device.change(Table::discrete_inputs, 3, i % 2 == 0);
  device.change(Table::coils, 20, true);  // the nineteenth
  device.next_errors.emplace_back(ExceptionReply{modbus::Exception::server_device_failure});
  push("lights", 0);
  engine->step();
  device.change(Table::coils, 21, true);
  run_for(milliseconds(200));
  EXPECT_THAT(sink->values["lights"], ElementsAre(0, 1)) << "the first of four";
}

TEST_F(ChangesTest, An_array_whose_change_was_not_shown_yet_is_not_shown_before_a_write_that_came_meanwhile) {
  begin(cell_with_lights());
  for (int i = 0; i < 17; ++i) device.change(Table::discrete_inputs, 3, i % 2 == 0);
  device.change(Table::coils, 20, true);  // the eighteenth: another bit of it might follow
  device.change(Table::discrete_inputs, 3, false);
  engine->arrived();
  push("lights", 0);
  run_for(milliseconds(200));
  EXPECT_THAT(sink->values["lights"], Each(0)) << "the first of four";
}

TEST_F(ChangesTest, An_answer_that_comes_too_late_is_followed_by_a_wait_before_anything_is_polled) {
  begin(fakes::MapBuilder().input("barrier", 3));
  clock.advance(seconds(20));  // the process was stopped
  for (int i = 0; i < 3; ++i) engine->step();
  EXPECT_THAT(device.requests, ElementsAre(StartsWith("wait"), StartsWith("read"), StartsWith("wait")));
}

/// A door that is told once in 300 ms at least.
struct RepeatedTest : ChangesTest {
  RepeatedTest() {
    door = cell();
    door.add(Table::discrete_inputs, "door", 9, codec::Type::BOOL, [](Point& point) {
      point.host.publish = Publish::on_change;
      point.host.max_interval = milliseconds(300);
    });
  }
  std::uint32_t index() const {
    return static_cast<std::uint32_t>(find(owned->map(), "door") - owned->map().points.data());
  }
  void subscribe(RecordingSink::Topic& topic) {
    topic.policy.renew();
    engine->want(index(), true);
  }
  static Duration longest_gap(const RecordingSink::Topic& topic) {
    Duration longest{};
    for (std::size_t i = 1; i < topic.published.size(); ++i)
      longest = std::max(longest, topic.published[i] - topic.published[i - 1]);
    return longest;
  }
  MapBuilder door;
};

constexpr auto soon_enough = milliseconds(302);

TEST_F(RepeatedTest, A_point_with_max_interval_is_published_from_its_last_value) {
  begin(door);
  auto& topic = sink->add_topic("door");
  subscribe(topic);
  run_for(seconds(3));
  EXPECT_GE(topic.published.size(), 9U);
  EXPECT_LE(topic.published.size(), 11U);
  EXPECT_LE(longest_gap(topic), soon_enough);
  EXPECT_EQ(sink->values["barrier"].size(), 1U);
  EXPECT_LE(reads(), 2U) << "for the subscriber";
}

TEST_F(RepeatedTest, Someone_new_who_listens_makes_no_longer_interval) {
  begin(door);
  auto& topic = sink->add_topic("door");
  auto& stamped = sink->add_topic("door");
  subscribe(topic);
  run_for(milliseconds(650));
  subscribe(topic);
  run_for(milliseconds(70));
  subscribe(stamped);
  run_for(seconds(2));
  EXPECT_LE(longest_gap(topic), soon_enough);
  EXPECT_LE(longest_gap(stamped), soon_enough);
}

TEST_F(RepeatedTest, Lost_changes_make_no_longer_interval) {
  begin(door);
  auto& topic = sink->add_topic("door");
  subscribe(topic);
  run_for(milliseconds(850));
  for (int i = 0; i < 30; ++i) device.change(Table::discrete_inputs, 3, i % 2 == 0);
  device.forgotten = 30;
  run_for(seconds(2));
  EXPECT_LE(longest_gap(topic), soon_enough);
}

TEST_F(ChangesTest, A_node_is_asked_as_often_as_the_positions_of_tools_are_published) {
  static constexpr Tool tools[] = {{"cup", "light", {}, {}, {}, {}, milliseconds(300)}};
  MapBuilder builder = cell();
  builder.head().tools = tools;
  builder.head().joint_rate = 20;
  begin(builder);
  run_for(seconds(1));
  EXPECT_GE(device.count("wait 50"), 18U);
  EXPECT_LE(device.count("wait 50"), 22U);
}

struct PolledTest : ChangesTest {
  void expect_polled() {
    run_for(seconds(1));
    EXPECT_EQ(waits(), 0U);
    EXPECT_GE(reads(), 18U);
  }
};

TEST_F(PolledTest, Where_the_map_says_so) {
  MapBuilder builder = cell();
  builder.head().changes = false;
  begin(builder);
  expect_polled();
}

TEST_F(PolledTest, Where_the_connection_is_shared) {
  device.can_wait_for_changes = false;
  begin(cell());
  expect_polled();
}

TEST_F(PolledTest, Where_the_identity_is_not_asked_for) {
  serve(cell());
  device.tell_changes();
  start(cell(), Verify::off);
  expect_polled();
}

TEST_F(PolledTest, Where_an_older_node_does_not_say_that_it_tells_changes) {
  serve(cell());
  start(cell());
  expect_polled();
}

}  // namespace
}  // namespace coupler::host
