// SPDX-License-Identifier: Apache-2.0
// With limited rights a client hears what it may, with numbers of its own.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "coupler/device/core/client_changes.hpp"
#include "test/device/core/node_under_test.hpp"

namespace coupler::device {
namespace {

using fakes::MapBuilder;
using modbus::Change;
using testing::ElementsAre;
using testing::IsEmpty;

constexpr std::uint32_t epoch = 9;

class ClientChangesTest : public testing::Test {
 protected:
  ClientChangesTest() { ring_.begin(epoch); }

  /// Coils 0 and 2 may be read, 1 and 3 not.
  void change(std::uint16_t coil) { ring_.add({1, Change::Kind::on, coil, modbus::NodeTime(coil)}); }
  void outcome(std::uint16_t number, const ClientSession& owner) {
    ring_.add({0, Change::Kind::done, number, modbus::NodeTime(number)}, &owner);
  }
  bool has_news(ClientSession& client, std::uint64_t seen, std::uint32_t of = epoch) {
    client.wait = Wait{{1000, of, seen}};
    const Rights rights(map_->map(), client);
    return ClientChanges(ring_, rights, client).has_news();
  }
  modbus::ChangesReply ask(ClientSession& client, std::uint64_t seen, std::uint32_t of = epoch) {
    client.wait = Wait{{1000, of, seen}};
    const Rights rights(map_->map(), client);
    return ClientChanges(ring_, rights, client).reply();
  }
  static std::vector<int> of(const modbus::ChangesReply& reply) {
    std::vector<int> all;
    for (const Change& change : reply.all()) all.push_back(change.address);
    return all;
  }

  MapPtr map_ = MapBuilder()
                    .coil("a", 0)
                    .coil("secret", 1)
                    .coil("b", 2)
                    .coil("hidden", 3)
                    .everybody_may({"a", "b"}, {})
                    .build();
  std::vector<ChangeRing::Entry> places_{8};
  ChangeRing ring_{places_};
  ClientSession client_;
  ClientSession other_;
};

TEST_F(ClientChangesTest, Begin_with_the_connection_and_count_what_it_may_hear) {
  change(0);
  EXPECT_TRUE(has_news(client_, 0, 0));
  EXPECT_THAT(of(ask(client_, 0, 0)), IsEmpty());
  EXPECT_FALSE(has_news(client_, 0));
  change(1);
  EXPECT_FALSE(has_news(client_, 0)) << "it may not hear of that";
  change(2);
  change(3);
  change(0);
  EXPECT_TRUE(has_news(client_, 0));
  const auto reply = ask(client_, 0);
  EXPECT_THAT(of(reply), ElementsAre(2, 0));
  EXPECT_EQ(reply.lost, 0U);
  EXPECT_EQ(reply.newest, 2U);
  EXPECT_FALSE(has_news(client_, 2));
}

TEST_F(ClientChangesTest, Tell_how_many_are_still_to_come) {
  std::vector<ChangeRing::Entry> many(64);
  ring_ = ChangeRing(many);
  ring_.begin(epoch);
  (void)ask(client_, 0, 0);
  for (int i = 0; i < 20; ++i) {
    change(0);
    change(1);
  }
  const auto first = ask(client_, 0);
  EXPECT_EQ(first.count, 18);
  EXPECT_EQ(first.newest, 20U);
  const auto rest = ask(client_, 18);
  EXPECT_EQ(rest.count, 2);
  EXPECT_EQ(rest.newest, 20U);
}

TEST_F(ClientChangesTest, Lost_ones_count_as_one_though_they_may_have_been_others) {
  (void)ask(client_, 0, 0);
  ring_.lose(2);
  EXPECT_TRUE(has_news(client_, 0));
  change(0);
  const auto reply = ask(client_, 0);
  EXPECT_EQ(reply.lost, 1U);
  EXPECT_THAT(of(reply), ElementsAre(0));
  EXPECT_EQ(reply.newest, 2U);
  change(1);
  ring_.lose(1);
  change(3);
  EXPECT_EQ(ask(client_, 2).lost, 1U);
}

TEST_F(ClientChangesTest, What_follows_lost_ones_may_be_hidden_too) {
  (void)ask(client_, 0, 0);
  ring_.lose(1);
  change(1);
  const auto reply = ask(client_, 0);
  EXPECT_EQ(reply.lost, 1U);
  EXPECT_THAT(of(reply), IsEmpty());
  EXPECT_EQ(reply.newest, 1U);
}

TEST_F(ClientChangesTest, Those_that_were_overwritten_are_lost) {
  (void)ask(client_, 0, 0);
  for (int i = 0; i < 10; ++i) change(0);
  const auto reply = ask(client_, 0);
  EXPECT_EQ(reply.lost, 1U);
  EXPECT_EQ(reply.count, 8);
  EXPECT_EQ(reply.newest, 9U);
}

TEST_F(ClientChangesTest, An_outcome_is_for_the_connection_that_scheduled_it) {
  (void)ask(client_, 0, 0);
  (void)ask(other_, 0, 0);
  outcome(7, other_);
  EXPECT_FALSE(has_news(client_, 0));
  EXPECT_THAT(of(ask(other_, 0)), ElementsAre(7));
}

TEST_F(ClientChangesTest, Another_connection_begins_anew_in_the_same_epoch) {
  (void)ask(client_, 0, 0);
  change(0);
  EXPECT_THAT(of(ask(client_, 0)), ElementsAre(0));
  EXPECT_TRUE(has_news(other_, 1)) << "that its number means nothing here";
  const auto reply = ask(other_, 1);
  EXPECT_THAT(of(reply), IsEmpty());
  EXPECT_EQ(reply.newest, 0U);
}

TEST_F(ClientChangesTest, What_was_told_once_is_not_told_again) {
  (void)ask(client_, 0, 0);
  change(0);
  (void)ask(client_, 0);
  EXPECT_TRUE(has_news(client_, 0));
  const auto again = ask(client_, 0);
  EXPECT_EQ(again.lost, 1U);
  EXPECT_THAT(of(again), IsEmpty());
}

TEST_F(ClientChangesTest, Without_limits_the_numbers_are_the_nodes) {
  map_ = MapBuilder().coil("a", 0).build();
  change(0);
  outcome(7, other_);
  const auto reply = ask(client_, 0);
  EXPECT_THAT(of(reply), ElementsAre(0, 7));
  EXPECT_EQ(reply.newest, 2U);
}

}  // namespace
}  // namespace coupler::device
