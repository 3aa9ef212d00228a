// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/core/turn_order.hpp"

#include <gtest/gtest.h>

#include <string>

namespace coupler::host {
namespace {

struct TurnOrderTest : testing::Test {
  TurnOrder order;
  const std::string units = "ABC";

  TurnOrder::Who who(char unit) const { return &units[units.find(unit)]; }
  void read(char unit) { order.come(who(unit), Rank::read); }
  void write_at_once(char unit) { order.count_write(who(unit)); }
  void write(char unit) { order.come(who(unit), Rank::write); }
  /// Who gets the turn one after the other, if each waits for one only.
  std::string rest() {
    std::string all;
    while (const auto* const next = static_cast<const char*>(order.next())) {
      order.serve();
      all += *next;
    }
    return all;
  }
};

TEST_F(TurnOrderTest, Reads_come_in_the_order_in_which_they_came) {
  read('C');
  read('A');
  read('B');
  EXPECT_EQ(rest(), "CAB");
}

TEST_F(TurnOrderTest, Writes_come_before_reads_and_in_the_order_in_which_they_came) {
  read('A');
  write('C');
  write('B');
  EXPECT_EQ(rest(), "CBA");
}

TEST_F(TurnOrderTest, Who_has_written_since_the_last_read_lets_one_read_go_first) {
  write('B');
  EXPECT_EQ(rest(), "B");
  read('A');
  read('C');
  write('B');
  EXPECT_EQ(rest(), "ABC");
}

TEST_F(TurnOrderTest, So_does_who_has_written_without_waiting) {
  write_at_once('B');
  read('A');
  write('B');
  EXPECT_EQ(rest(), "AB");
}

TEST_F(TurnOrderTest, Two_that_never_stop_writing_do_not_keep_a_read_waiting_for_ever) {
  read('C');
  write('A');
  write('B');
  std::string all;
  for (int turn = 0; turn < 3; ++turn) {
    const char unit = *static_cast<const char*>(order.next());
    all += unit;
    order.serve();
    if (unit != 'C') write(unit);
  }
  EXPECT_EQ(all, "ABC");
}

TEST_F(TurnOrderTest, Without_a_read_that_waits_nobody_holds_back) {
  write('A');
  EXPECT_EQ(rest(), "A");
  write('A');
  write('B');
  EXPECT_EQ(rest(), "BA");
  write('A');
  EXPECT_EQ(rest(), "A");
}

TEST_F(TurnOrderTest, A_read_that_made_room_for_a_write_of_its_unit_keeps_its_place) {
  read('A');
  read('B');
  order.leave(who('A'));
  write('A');
  ASSERT_EQ(order.next(), who('A'));
  order.serve();
  EXPECT_EQ(order.next(), who('B'));
  read('A');
  EXPECT_EQ(rest(), "AB");
}

TEST_F(TurnOrderTest, Who_waits_for_both_writes_once_between_reads_and_reads_in_the_order_of_coming) {
  write('A');
  order.serve();
  read('B');
  read('C');
  std::string all;
  for (int turn = 0; turn < 5; ++turn) {
    read('A');
    write('A');
    const char unit = *static_cast<const char*>(order.next());
    all += order.serve() == Rank::read ? unit : static_cast<char>(unit + ('a' - 'A'));
  }
  EXPECT_EQ(all, "BaCaA") << "small letters write";
}

TEST_F(TurnOrderTest, Who_has_left_is_not_next) {
  write('A');
  read('B');
  order.leave(who('A'));
  order.leave(who('B'));
  EXPECT_EQ(order.next(), nullptr);
}

TEST_F(TurnOrderTest, Who_claims_all_turns_has_each_until_the_claim_ends) {
  write('A');
  read('B');
  order.claim(who('C'));
  EXPECT_EQ(order.next(), nullptr) << "between two of his requests, too";
  EXPECT_TRUE(order.is_free_for(who('C')));
  EXPECT_FALSE(order.is_free_for(who('B')));
  order.come(who('C'), Rank::safe);
  ASSERT_EQ(order.next(), who('C'));
  order.serve();
  order.give_up_claim(who('C'));
  EXPECT_EQ(rest(), "AB");
}

}  // namespace
}  // namespace coupler::host
