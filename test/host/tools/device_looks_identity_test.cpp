// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include "test/host/tools/look_fixture.hpp"

namespace coupler::tools::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using State = Reading::State;
using Verdict = host::Identity::Verdict;

/// A node of this project that serves `its` map.
struct OnNode : Looking {
  OnNode(const MapBuilder& ours, const MapBuilder& its) : Looking(ours), node(its.build()) {
    device.missing.clear();
    device.serve(node->map());
    loads.map = node;
  }
  MapPtr node;
};

TEST(DeviceLooks, A_node_with_the_same_map_is_read_without_a_word) {
  OnNode node(MapBuilder().coil("a", 0), MapBuilder().coil("a", 0));
  const Snapshot now = node.look();
  EXPECT_EQ(now.identity, Verdict::equal);
  EXPECT_THAT(now.notes, IsEmpty());
}

TEST(DeviceLooks, A_node_with_more_points_is_read_and_that_is_told) {
  OnNode node(MapBuilder().coil("a", 0), MapBuilder().coil("a", 0).coil("b", 1));
  const Snapshot now = node.look();
  EXPECT_EQ(now.identity, Verdict::superset);
  EXPECT_EQ(now.failed(), 0U);
  EXPECT_THAT(now.notes, ElementsAre(HasSubstr("more points")));
}

TEST(DeviceLooks, Of_a_node_with_another_map_only_what_is_the_same_is_read) {
  OnNode node(MapBuilder().coil("a", 0).coil("moved", 1).coil("gone", 2).coil("b", 3),
              MapBuilder().coil("a", 0).coil("moved", 7).coil("b", 3).coil("new", 1));
  const Snapshot now = node.look();
  EXPECT_EQ(now.identity, Verdict::different);
  EXPECT_EQ(node.of(now, "a").state, State::good);
  EXPECT_EQ(node.of(now, "b").state, State::good);
  EXPECT_EQ(node.of(now, "moved").why, "different in the device's map: address 1 -> 7");
  EXPECT_EQ(node.of(now, "gone").why, "not in the device's map");
  EXPECT_EQ(now.failed(), 2U);
  ASSERT_EQ(now.notes.size(), 1U);
  EXPECT_THAT(now.notes[0], HasSubstr("- gone: missing (coils 2, BOOL)"));
  EXPECT_EQ(node.device.count("read coils 0+1"), 1U);
  EXPECT_EQ(node.device.count("read coils 3+1"), 1U);
  node.requests();
  node.look();
  EXPECT_THAT(node.requests(), ElementsAre("read coils 0+1", "read coils 3+1"));
}

TEST(DeviceLooks, Of_a_node_whose_map_cannot_be_compared_nothing_is_read) {
  OnNode node(MapBuilder().coil("a", 0), MapBuilder().coil("a", 7));
  node.loads = {};
  const Snapshot now = node.look();
  EXPECT_EQ(now.readings.at(0).why, "the device's map cannot be compared");
  ASSERT_EQ(now.notes.size(), 1U);
  EXPECT_THAT(now.notes[0], testing::Not(HasSubstr("To read by the device's own map")))
      << "nor can that be had";
  EXPECT_EQ(node.device.count("read coils 0+1"), 0U);
}

TEST(DeviceLooks, The_map_is_compared_again_at_every_connect) {
  OnNode node(MapBuilder().coil("a", 0), MapBuilder().coil("a", 0));
  EXPECT_EQ(node.look().failed(), 0U);
  node.device.next_errors = {host::TransportFailure{"gone"}};
  EXPECT_FALSE(node.look().online());
  const MapPtr other = MapBuilder().coil("a", 7).build();
  node.device.serve(other->map());
  node.loads.map = other;
  const Snapshot now = node.look();
  EXPECT_TRUE(now.online());
  EXPECT_EQ(now.failed(), 1U);
}

TEST(DeviceLooks, A_coupler_that_ignores_the_question_for_its_identity_is_read_over_a_new_connection) {
  Looking looking(MapBuilder().coil("a", 0));
  looking.device.next_errors = {host::Timeout{std::chrono::milliseconds(9)}};
  const Snapshot now = looking.look();
  EXPECT_EQ(now.failed(), 0U);
  EXPECT_EQ(now.identity, std::nullopt);
  EXPECT_THAT(now.notes,
              ElementsAre(HasSubstr("does not answer the request for its identity (no reply within 9 ms)")));
  EXPECT_THAT(looking.requests(), ElementsAre("connect", identity_question, "connect", "read coils 0+1"));
}

TEST(DeviceLooks, Only_a_request_without_an_answer_is_told_of_as_one) {
  Looking silent(MapBuilder().coil("a", 0));
  silent.device.next_errors = {host::Timeout{std::chrono::milliseconds(9)}};
  silent.look();
  EXPECT_EQ(silent.silences, 1);

  MapBuilder builder;
  builder.holding("a", 0).holding("b", 4);
  builder.head().polling.register_continuous = true;
  builder.head().verify = Verify::off;
  Looking answering(builder);
  answering.device.missing.insert({Table::holding_registers, 2});
  EXPECT_THAT(answering.look().notes, ElementsAre(HasSubstr("the device rejects")));
  EXPECT_EQ(answering.silences, 0);
}

TEST(DeviceLooks, A_node_that_comes_up_behind_a_gateway_is_asked_for_its_map) {
  OnNode node(MapBuilder().coil("a", 0).coil("b", 1), MapBuilder().coil("a", 0).coil("b", 7));
  node.device.during_read = [&node] {
    node.device.next_errors = {host::TransportFailure{"closed", false, true}};
  };
  EXPECT_FALSE(node.look().online());
  node.device.during_read = nullptr;
  const Snapshot now = node.look();
  EXPECT_EQ(now.identity, Verdict::different);
  EXPECT_EQ(node.of(now, "b").why, "different in the device's map: address 1 -> 7");
}

TEST(DeviceLooks, A_node_that_falls_silent_while_it_gives_its_map_is_no_foreign_coupler) {
  OnNode node(MapBuilder().coil("a", 0), MapBuilder().text("a: 7").coil("a", 7));
  node.device.during_read = [&node] {
    // The answer to the first question comes; the next request is that for the map.
    node.device.refuses = [&node](const std::string& request) -> std::optional<modbus::Exception> {
      if (request.rfind("read file", 0) == 0)
        node.device.next_errors = {host::Timeout{std::chrono::milliseconds(9)}};
      return std::nullopt;
    };
  };
  const Snapshot now = node.look();
  EXPECT_EQ(to_string(*now.error), "no reply within 9 ms");
  EXPECT_EQ(node.device.count("read coils 0+1"), 0U);
}

}  // namespace
}  // namespace coupler::tools::test
