// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/ros/topic_check.hpp"

#include <gmock/gmock.h>

#include <array>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace coupler::host {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::StartsWith;

constexpr bool publishes = true;
constexpr bool subscribes = false;

Point point(std::string_view name, Table table, Access access) {
  Point made;
  made.name = name;
  made.table = table;
  made.access = access;
  return made;
}

/// The driver of a press in the namespace /cell, and what it says of others.
struct TopicCheckTest : ::testing::Test {
  TopicCheckTest() {
    points[1].host.stamped = true;
    map.name = "press";
    map.points = points;
    check.add_device("/cell/press", map);
    check.add_published("/cell/press/online", "std_msgs/Bool");
    check.add_published("/cell/press/lamp", "std_msgs/Bool", &points[0]);
    check.add_written("/cell/press/lamp/write", "std_msgs/Bool", points[0]);
    check.add_published("/cell/press/flow", "std_msgs/UInt16", &points[1]);
    check.add_published("/cell/press/flow/stamped", "coupler_driver/UInt64Stamped");
    check.add_written("/cell/press/order/write", "std_msgs/UInt16", points[2]);
    check.add_published("/clamp", "std_msgs/Bool", &points[3]);  // remapped
    check.add_written("/cell/press/valve/write", "std_msgs/Bool", points[3]);
  }

  std::vector<std::string> told(const std::vector<Endpoint>& others) const {
    std::vector<std::string> lines;
    for (const Finding& one : check.check(others))
      if (auto text = one.text(); !text.empty()) lines.push_back(std::move(text));
    return lines;
  }

  std::array<Point, 5> points{point("lamp", Table::coils, Access::read_write),
                              point("flow", Table::input_registers, Access::read),
                              point("order", Table::holding_registers, Access::write),
                              point("valve", Table::coils, Access::read_write),
                              point("level", Table::holding_registers, Access::read_write)};
  Map map;
  TopicCheck check;
};

TEST_F(TopicCheckTest, A_publisher_of_another_type_is_told_what_to_publish) {
  EXPECT_THAT(told({{"/cell/press/lamp/write", "/ui", publishes, "std_msgs/Int32"}}),
              ElementsAre("/cell/press/lamp/write: node /ui publishes std_msgs/Int32, and this topic is "
                          "std_msgs/Bool: its messages do not arrive. Publish std_msgs/Bool"));
}

TEST_F(TopicCheckTest, A_subscriber_with_another_type_is_told_what_to_subscribe_to) {
  for (const char* const topic :
       {"/cell/press/flow", "/cell/press/flow/stamped", "/cell/press/online", "/clamp"})
    EXPECT_THAT(
        told({{topic, "/ui", subscribes, "std_msgs/Float32"}}),
        ElementsAre(StartsWith(std::string(topic) + ": node /ui subscribes to std_msgs/Float32, and ")));
}

TEST_F(TopicCheckTest, A_point_that_was_not_chosen_to_have_topics_is_told) {
  EXPECT_THAT(
      told({{"/cell/press/level", "/ui", subscribes, "std_msgs/UInt16"},
            {"/cell/press/level/write", "/ui", publishes, "std_msgs/UInt16"}}),
      ElementsAre(testing::EndsWith("level has no topics. Name it in the setting 'topics' of the driver"),
                  testing::EndsWith("level has no topics. Name it in the setting 'topics' of the driver")));
}

TEST_F(TopicCheckTest, What_fits_and_a_type_that_is_any_or_not_known_is_not_told) {
  for (const char* const type : {"std_msgs/Bool", "*", ""})
    EXPECT_THAT(told({{"/cell/press/lamp", "/ui", subscribes, type},
                      {"/cell/press/lamp/write", "/ui", publishes, type}}),
                IsEmpty());
}

TEST_F(TopicCheckTest, Who_else_subscribes_to_writes_is_nobodys_business) {
  EXPECT_THAT(told({{"/cell/press/lamp/write", "/recorder", subscribes, "std_msgs/Int32"}}), IsEmpty());
}

TEST_F(TopicCheckTest, Who_else_publishes_what_this_node_does_is_told_where_to_write) {
  for (const auto& [topic, write] :
       {std::pair{"/cell/press/lamp", "/cell/press/lamp/write"}, {"/clamp", "/cell/press/valve/write"}})
    for (const char* const type : {"std_msgs/Bool", "std_msgs/Int32", ""})
      EXPECT_THAT(told({{topic, "/ui", publishes, type}}),
                  ElementsAre(fmt::format(
                      "{}: node /ui publishes here, too: its values are not the device's. If they are "
                      "to be written, publish at {}; otherwise remap this topic of /ui",
                      topic, write)));
  for (const char* const topic : {"/cell/press/flow", "/cell/press/flow/stamped"})
    EXPECT_THAT(told({{topic, "/player", publishes, "*"}}),
                ElementsAre(fmt::format(
                    "{}: node /player publishes here, too: its values are not the device's. Remap "
                    "this topic of /player",
                    topic)));
}

TEST_F(TopicCheckTest, Another_driver_of_the_device_is_not_told_of_at_each_topic) {
  EXPECT_THAT(told({{"/cell/press/lamp", "/other", publishes, "std_msgs/Bool"},
                    {"/cell/press/online", "/other", publishes, "std_msgs/Bool"},
                    {"/cell/press/flow", "/ui", publishes, "std_msgs/UInt16"}}),
              ElementsAre(StartsWith("/cell/press/flow: node /ui ")));
}

TEST_F(TopicCheckTest, A_publisher_of_what_is_read_only_is_told_why) {
  EXPECT_THAT(
      told({{"/cell/press/flow/write", "/ui", publishes, "std_msgs/UInt16"},
            {"/cell/press/flow/write", "/recorder", subscribes, "*"}}),
      ElementsAre("/cell/press/flow/write: node /ui publishes here, and the point flow is read only: nothing "
                  "is written. No device lets input_registers be written"));
  points[1].table = Table::holding_registers;
  EXPECT_THAT(
      told({{"/cell/press/flow/write", "/ui", publishes, "std_msgs/UInt16"}}),
      ElementsAre("/cell/press/flow/write: node /ui publishes here, and the point flow is read only: nothing "
                  "is written. If the device lets it be written, give it 'access: read_write' in the map"));
}

TEST_F(TopicCheckTest, A_subscriber_of_what_is_write_only_is_told_unless_another_publishes_there) {
  EXPECT_THAT(
      told({{"/cell/press/order", "/ui", subscribes, "std_msgs/UInt16"}}),
      ElementsAre("/cell/press/order: node /ui subscribes, and the point order is write only: it receives "
                  "nothing. If the device lets it be read, give it 'access: read_write' in the map"));
  EXPECT_THAT(told({{"/cell/press/order", "/ui", subscribes, "std_msgs/UInt16"},
                    {"/cell/press/order", "/echo", publishes, "std_msgs/UInt16"}}),
              IsEmpty());
}

TEST_F(TopicCheckTest, A_subscriber_of_stamps_that_there_are_not_is_told_of_the_key) {
  EXPECT_THAT(
      told({{"/cell/press/lamp/stamped", "/ui", subscribes, "coupler_driver/BoolStamped"}}),
      ElementsAre("/cell/press/lamp/stamped: node /ui subscribes, and the point lamp is not stamped: it "
                  "receives nothing. Give it 'stamped: true' in the map"));
}

TEST_F(TopicCheckTest, Who_follows_one_half_of_a_remapping_is_told_of_the_other) {
  EXPECT_THAT(
      told({{"/clamp/write", "/ui", publishes, "std_msgs/Bool"}}),
      ElementsAre("/clamp/write: node /ui publishes here, and nobody listens; the topic of a point and its "
                  "/write are remapped one by one: remap the other one, too"));
  EXPECT_THAT(told({{"/cell/press/valve", "/ui", subscribes, "std_msgs/Bool"}}),
              ElementsAre(StartsWith(
                  "/cell/press/valve: node /ui subscribes, and nobody publishes here; the topic")));
  EXPECT_THAT(told({{"/clamp/write", "/ui", publishes, "std_msgs/Bool"},
                    {"/clamp/write", "/clamp", subscribes, "std_msgs/Bool"}}),
              IsEmpty());
}

TEST_F(TopicCheckTest, A_misspelt_topic_is_told_with_the_one_that_was_meant) {
  EXPECT_THAT(told({{"/cell/press/lmap/write", "/ui", publishes, "std_msgs/Bool"}}),
              ElementsAre("/cell/press/lmap/write: node /ui publishes here, and nobody listens; did you mean "
                          "/cell/press/lamp/write?"));
  EXPECT_THAT(told({{"/cell/press/folw", "/ui", subscribes, "std_msgs/UInt16"}}),
              ElementsAre("/cell/press/folw: node /ui subscribes, and nobody publishes here; did you mean "
                          "/cell/press/flow?"));
  EXPECT_THAT(told({{"/cell/press/folw/stamped", "/ui", subscribes, "coupler_driver/UInt64Stamped"}}),
              ElementsAre(::testing::HasSubstr("did you mean /cell/press/flow/stamped?")));
  EXPECT_THAT(told({{"/cell/press/onlin", "/ui", subscribes, "std_msgs/Bool"}}),
              ElementsAre(::testing::HasSubstr("did you mean /cell/press/online?")));
}

TEST_F(TopicCheckTest, A_publisher_that_forgets_or_misspells_the_end_is_told_where_to_write) {
  for (const char* const topic :
       {"/cell/press/lamp/wirte", "/cell/press/lamp/set", "/cell/press/lmap", "/cell/press/lmap/wirte"})
    EXPECT_THAT(
        told({{topic, "/ui", publishes, "std_msgs/Bool"}}),
        ElementsAre(std::string(topic) + ": node /ui publishes here, and nobody listens; did you mean "
                                         "/cell/press/lamp/write?"));
  EXPECT_THAT(told({{"/cell/press/order", "/ui", publishes, "std_msgs/UInt16"}}),
              ElementsAre(::testing::HasSubstr("did you mean /cell/press/order/write?")));
  EXPECT_THAT(told({{"/cell/press/write", "/ui", publishes, "std_msgs/Bool"}}),
              ElementsAre("/cell/press/write: node /ui publishes here, and nobody listens: it has no point. "
                          "Publish at the point's, as /cell/press/lamp/write"));
  EXPECT_THAT(told({{"/cell/press/lamp/wirte", "/ui", publishes, "std_msgs/Bool"},
                    {"/cell/press/lamp/wirte", "/other", subscribes, "std_msgs/Bool"}}),
              IsEmpty());
}

TEST_F(TopicCheckTest, A_publisher_that_misspells_the_device_is_told_if_it_can_be_no_other) {
  for (const char* const topic :
       {"/cell/pres/lamp/write", "/cel/press/lamp/write", "/cell/perss/lamp/write"}) {
    EXPECT_TRUE(check.concerns(topic)) << topic;
    EXPECT_THAT(
        told({{topic, "/ui", publishes, "std_msgs/Bool"}}),
        ElementsAre(std::string(topic) + ": node /ui publishes here, and nobody listens; did you mean "
                                         "/cell/press/lamp/write?"));
  }
  for (const char* const topic :
       {"/cell/press2/lamp/write", "/cell/prest/lamp/write", "/cell/pres/lmap/write", "/cell/pres/lamp",
        "/cell/pr/lamp/write", "/lamp/write"}) {
    EXPECT_FALSE(check.concerns(topic)) << topic;
    EXPECT_THAT(told({{topic, "/ui", publishes, "std_msgs/Bool"}}), IsEmpty()) << topic;
  }
  check.add_device("/cell/presss", map);
  check.add_written("/cell/presss/lamp/write", "std_msgs/Bool", points[0]);
  EXPECT_THAT(told({{"/cell/pres/lamp/write", "/ui", publishes, "std_msgs/Bool"}}), ::testing::SizeIs(1));
  check.add_device("/cell/prses", map);
  check.add_written("/cell/prses/lamp/write", "std_msgs/Bool", points[0]);
  EXPECT_THAT(told({{"/cell/pres/lamp/write", "/ui", publishes, "std_msgs/Bool"}}), IsEmpty())
      << "it may be the one or the other";
}

TEST_F(TopicCheckTest, A_topic_of_others_below_the_device_is_not_told) {
  EXPECT_THAT(told({{"/cell/press/lamb/write", "/ui", publishes, "std_msgs/Bool"},
                    {"/cell/press/lamb/write", "/lamb", subscribes, "std_msgs/Bool"}}),
              IsEmpty())
      << "they have each other";
  EXPECT_THAT(told({{"/cell/press/filtered_pressure", "/ui", subscribes, "std_msgs/Float32"},
                    {"/cell/press/gripper/write", "/ui", publishes, "std_msgs/Bool"},
                    {"/cell/press/filtered", "/ui", publishes, "std_msgs/Float32"},
                    {"/cell/press/flow/filtered", "/ui", publishes, "std_msgs/Float32"},
                    {"/cell/press/lmap/filtered", "/ui", publishes, "std_msgs/Bool"}}),
              IsEmpty())
      << "nothing is near";
  EXPECT_THAT(told({{"/other/lmap/write", "/ui", publishes, "std_msgs/Bool"}}), IsEmpty());
}

TEST_F(TopicCheckTest, What_need_not_be_looked_at_is_known_by_its_name) {
  EXPECT_EQ(check.needed_type("/cell/press/lamp/write", publishes), "std_msgs/Bool");
  EXPECT_EQ(check.needed_type("/cell/press/lamp/write", subscribes), "");
  for (const char* const topic : {"/cell/press/lmap", "/clamp", "/clamp/write", "/clamp/stamped"})
    EXPECT_TRUE(check.concerns(topic)) << topic;
  for (const char* const topic : {"/tf", "/write", "/cell/lamp"})
    EXPECT_FALSE(check.concerns(topic)) << topic;
}

TEST_F(TopicCheckTest, Findings_of_which_the_text_is_a_guess_stand_last) {
  const auto findings = check.check({{"/cell/press/lmap/write", "/ui", publishes, "std_msgs/Bool"},
                                     {"/cell/press/lamp/write", "/ui", publishes, "std_msgs/Int32"}});
  ASSERT_EQ(findings.size(), 2U);
  EXPECT_TRUE(findings[0].is_sure);
  EXPECT_FALSE(findings[1].is_sure);
}

TEST(TopicCheck, All_points_that_a_device_may_have_are_looked_at_in_one_pass) {
  constexpr std::size_t count = 65000;
  std::vector<std::string> names;
  for (std::size_t i = 0; i < count; ++i) names.push_back("p" + std::to_string(i));
  const Point lamp = point("lamp", Table::coils, Access::read_write);
  TopicCheck check;
  std::vector<Endpoint> others;
  for (const std::string& name : names) {
    check.add_published("/press/" + name, "std_msgs/Bool", &lamp);
    check.add_written("/press/" + name + "/write", "std_msgs/Bool", lamp);
    others.push_back({"/press/" + name, "/recorder", subscribes, "std_msgs/Bool"});
    others.push_back({"/press/" + name + "/write", "/ui", publishes, "std_msgs/Int32"});
  }
  OnceWarnings warnings;
  EXPECT_EQ(warnings.update(check.check(others), "more").size(), OnceWarnings::most_at_once + 1);
}

}  // namespace
}  // namespace coupler::host
