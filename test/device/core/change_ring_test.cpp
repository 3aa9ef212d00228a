// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "coupler/device/core/change_ring.hpp"

namespace coupler::device {
namespace {

using modbus::Change;
using testing::ElementsAre;
using testing::IsEmpty;

struct Ring : testing::Test {
  static constexpr std::uint32_t epoch = 0x12345678;
  Ring() { ring.begin(epoch); }
  /// Changes of the bits `first` … `last`.
  void add(int first, int last) {
    for (int bit = first; bit <= last; ++bit)
      ring.add({1, Change::Kind::on, static_cast<std::uint16_t>(bit), modbus::NodeTime(bit)});
  }
  modbus::ChangesReply ask(std::uint64_t seen, std::uint32_t of = epoch) const {
    return ring.reply_to({0, of, seen});
  }
  bool has_news(std::uint64_t seen, std::uint32_t of = epoch) const { return ring.has_news({0, of, seen}); }
  static std::vector<int> bits(const modbus::ChangesReply& reply) {
    std::vector<int> all;
    for (const Change& change : reply.all()) all.push_back(change.address);
    return all;
  }

  std::vector<ChangeRing::Entry> places{20};
  ChangeRing ring{places};
};

TEST_F(Ring, Changes_are_numbered_from_1_and_told_from_the_number_that_a_client_has_seen) {
  EXPECT_EQ(ring.newest(), 0U);
  add(7, 9);
  EXPECT_EQ(ring.newest(), 3U);
  const auto reply = ask(1);
  EXPECT_EQ(reply.epoch, epoch);
  EXPECT_EQ(reply.newest, 3U);
  EXPECT_EQ(reply.lost, 0U);
  EXPECT_THAT(bits(reply), ElementsAre(8, 9));
  EXPECT_EQ(reply.changes[0], (Change{1, Change::Kind::on, 8, modbus::NodeTime(8)}));
}

TEST_F(Ring, There_is_news_if_a_change_is_newer_than_the_number_seen) {
  EXPECT_FALSE(has_news(0));
  add(1, 2);
  EXPECT_TRUE(has_news(1));
  EXPECT_FALSE(has_news(2));
}

TEST_F(Ring, More_than_18_changes_take_another_request) {
  add(1, 20);
  const auto first = ask(0);
  EXPECT_EQ(first.count, 18);
  EXPECT_EQ(first.newest, 20U);
  EXPECT_THAT(bits(ask(18)), ElementsAre(19, 20));
}

TEST_F(Ring, What_is_overwritten_unseen_is_lost) {
  add(1, 25);
  const auto reply = ask(2);
  EXPECT_EQ(reply.lost, 3U) << "3, 4 and 5";
  EXPECT_EQ(bits(reply).front(), 6);
  EXPECT_EQ(ask(5).lost, 0U);
}

TEST_F(Ring, What_nobody_saw_is_lost_at_its_place_between_the_others) {
  add(1, 2);
  ring.lose(3);
  add(6, 7);
  EXPECT_EQ(ring.newest(), 7U);
  EXPECT_THAT(bits(ask(0)), ElementsAre(1, 2)) << "a reply tells what was lost before its first change only";
  EXPECT_EQ(ask(2).lost, 3U);
  EXPECT_THAT(bits(ask(2)), ElementsAre(6, 7));
  EXPECT_EQ(ask(4).lost, 1U);
}

TEST_F(Ring, A_loss_is_news_without_a_change) {
  add(1, 1);
  ring.lose(2);
  EXPECT_TRUE(has_news(1));
  EXPECT_EQ(ask(1).lost, 2U);
  EXPECT_THAT(bits(ask(1)), IsEmpty());
  EXPECT_FALSE(has_news(3));
}

TEST_F(Ring, Numbers_of_another_epoch_or_that_were_never_given_begin_anew) {
  add(1, 3);
  for (const auto& reply : {ask(1, 0), ask(1, epoch + 1), ask(4)}) {
    EXPECT_EQ(reply.epoch, epoch);
    EXPECT_EQ(reply.newest, 3U);
    EXPECT_EQ(reply.lost, 0U);
    EXPECT_THAT(bits(reply), IsEmpty());
  }
  EXPECT_TRUE(has_news(3, epoch + 1));
  EXPECT_TRUE(has_news(4));
}

TEST_F(Ring, Each_epoch_has_numbers_of_its_own) {
  add(1, 3);
  ring.begin(epoch + 1);
  EXPECT_EQ(ring.newest(), 0U);
  add(9, 9);
  EXPECT_THAT(bits(ask(0, epoch + 1)), ElementsAre(9));
}

TEST_F(Ring, A_loss_that_the_reply_cannot_tell_is_told_in_several) {
  constexpr auto most = std::numeric_limits<std::uint32_t>::max();
  ring.lose(most);
  ring.lose(5);
  add(1, 1);
  EXPECT_EQ(ask(0).lost, most);
  EXPECT_THAT(bits(ask(0)), IsEmpty());
  EXPECT_EQ(ask(most).lost, 5U);
  EXPECT_THAT(bits(ask(most)), ElementsAre(1));
}

TEST(RingWithoutPlaces, Every_change_is_lost) {
  ChangeRing ring;
  ring.begin(1);
  ring.add({1, Change::Kind::on, 0, {}});
  EXPECT_EQ(ring.reply_to({0, 1, 0}).lost, 1U);
}

}  // namespace
}  // namespace coupler::device
