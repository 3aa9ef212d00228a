// SPDX-License-Identifier: Apache-2.0
#include "coupler/map/lock/allocate.hpp"

#include <gtest/gtest.h>

namespace coupler::lock {
namespace {

constexpr Table table = Table::holding_registers;
const std::vector<std::uint16_t> halves{0xFF00, 0x00FF};
const std::vector<std::uint16_t> three_bits{1, 2, 4};

Request request(std::string_view name, std::uint32_t size = 1, std::uint16_t alignment = 1,
                std::vector<std::uint16_t> masks = {}) {
  return {name, table, size, alignment, std::move(masks)};
}
Place place(std::uint32_t start, std::uint32_t count = 1, std::uint16_t mask = whole) {
  return {table, modbus::Range::of(start, count), mask};
}

/// "1.high": without the table.
std::string text_of(const Place& place) {
  const std::string text = to_string(place);
  return text.substr(text.find(' ') + 1);
}

/// "0 1.high - 4-5": the places of the answers, - where there is none.
std::string places(const Allocation& allocation) {
  std::string text;
  for (const Answer& answer : allocation.answers) {
    const bool placed = answer.kind == Answer::Kind::recalled || answer.kind == Answer::Kind::allocated;
    text += (text.empty() ? "" : " ") + (placed ? text_of(answer.place) : "-");
  }
  return text;
}

/// "0:a 3:b!": the entries, ! those that are retired.
std::string entries(const Lock& lock) {
  std::string text;
  for (const Entry& entry : lock)
    text += (text.empty() ? "" : " ") + text_of(entry.place) + ":" + entry.name + (entry.retired ? "!" : "");
  return text;
}

std::string placed(const std::vector<Request>& requests, const FreeSpace& free_space = {},
                   const Lock& lock = {}) {
  return places(allocate(requests, free_space, lock, Unknown::allocated));
}

TEST(Allocation, The_first_place_is_taken_that_is_large_enough) {
  EXPECT_EQ(placed({request("a"), request("b", 3), request("c")}), "0 1-3 4");
  EXPECT_EQ(placed({request("a", 2), request("b")}, {{place(1)}, {}}), "2-3 0");
}

TEST(Allocation, Wide_values_are_aligned_and_smaller_ones_fill_the_gap) {
  EXPECT_EQ(placed({request("a"), request("b", 4, 4), request("c", 2, 2), request("d")}), "0 4-7 2-3 1");
}

TEST(Allocation, Parts_share_a_register) {
  EXPECT_EQ(placed({request("a", 1, 1, halves), request("b", 1, 1, halves), request("c", 1, 1, halves)}),
            "0.high 0.low 1.high");
  EXPECT_EQ(placed({request("a", 1, 1, three_bits), request("b"), request("c", 1, 1, three_bits),
                    request("d", 1, 1, halves)}),
            "0.0 1 0.1 0.high");
}

TEST(Allocation, A_part_that_is_asked_for_is_given) {
  EXPECT_EQ(placed({request("a", 1, 1, {0x00FF}), request("b", 1, 1, {0x00FF}), request("c", 1, 1, halves)}),
            "0.low 1.low 0.high");
}

TEST(Allocation, Tables_have_nothing_to_do_with_each_other) {
  EXPECT_EQ(placed({{"a", Table::coils}, {"b", Table::discrete_inputs}, {"c", Table::coils}}), "0 0 1");
}

TEST(Allocation, Points_stay_within_one_open_area) {
  EXPECT_EQ(placed({request("a", 2), request("b", 2), request("c"), request("d")},
                   {{}, {place(3, 3), place(6, 3)}}),
            "3-4 6-7 5 8");
}

TEST(Allocation, A_table_may_be_full) {
  const auto allocation =
      allocate({request("a"), request("b")}, {{place(1, 65535)}, {}}, {}, Unknown::allocated);
  EXPECT_EQ(places(allocation), "0 -");
  EXPECT_EQ(allocation.answers[1].kind, Answer::Kind::full);
  EXPECT_EQ(placed({request("a", 4, 4)}, {{place(0, 65533)}, {}}), "-");
}

TEST(Allocation, What_the_lock_knows_stays_where_it_is) {
  const Lock lock{{place(7), "b"}, {place(9), "a"}};
  EXPECT_EQ(placed({request("a"), request("b"), request("c")}, {}, lock), "9 7 0");
}

TEST(Allocation, The_place_of_a_retired_point_is_nobody_elses) {
  const auto without = allocate({request("b")}, {}, {{place(0), "a"}}, Unknown::allocated);
  EXPECT_EQ(entries(without.lock), "0:a! 1:b");
  const auto again = allocate({request("a"), request("c")}, {}, without.lock, Unknown::allocated);
  EXPECT_EQ(places(again), "0 2");
  EXPECT_EQ(entries(again.lock), "0:a 1:b! 2:c");
}

TEST(Allocation, A_point_that_becomes_smaller_keeps_its_room) {
  const auto smaller = allocate({request("a"), request("b")}, {}, {{place(0, 2), "a"}}, Unknown::allocated);
  EXPECT_EQ(places(smaller), "0 2");
  EXPECT_EQ(entries(smaller.lock), "0-1:a 2:b");
  EXPECT_EQ(placed({request("a", 2)}, {}, smaller.lock), "0-1");
  EXPECT_EQ(placed({request("a", 1, 1, halves)}, {}, {{place(3), "a"}}), "3.high");
  EXPECT_EQ(placed({request("a", 1, 1, three_bits)}, {}, {{place(3, 1, 0x00FF), "a"}}), "3.0");
}

TEST(Allocation, A_point_that_outgrew_its_place_is_not_moved) {
  const auto check = [](const Request& grown, const Place& room) {
    const Lock lock{{room, "a"}};
    const auto allocation = allocate({grown}, {}, lock, Unknown::allocated);
    EXPECT_EQ(allocation.answers[0].kind, Answer::Kind::misfit);
    EXPECT_EQ(allocation.answers[0].entry, &lock[0]);
    EXPECT_TRUE(equal(allocation.lock, lock));
  };
  check(request("a", 2), place(4));
  check(request("a"), place(4, 1, 0xFF00));
  check(request("a", 1, 1, {0x00FF}), place(4, 1, 0xFF00));
}

TEST(Allocation, What_is_unknown_may_be_refused) {
  const auto allocation = allocate({request("a"), request("b")}, {}, {{place(5), "a"}}, Unknown::refused);
  EXPECT_EQ(places(allocation), "5 -");
  EXPECT_EQ(allocation.answers[1].kind, Answer::Kind::unknown);
  EXPECT_EQ(entries(allocation.lock), "5:a");
}

}  // namespace
}  // namespace coupler::lock
