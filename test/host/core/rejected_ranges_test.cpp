// SPDX-License-Identifier: Apache-2.0
// What the poll cycle does with a request that the device does not take.
#include <gmock/gmock.h>

#include <random>

#include "test/host/core/poll_cycle_fixture.hpp"

namespace coupler::host {
namespace {

using fakes::MapBuilder;
using test::registers;
using testing::Contains;
using testing::Each;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::Not;

constexpr Table holding = Table::holding_registers;

using RejectedRangesTest = test::PollCycleTest;

TEST_F(RejectedRangesTest,
       A_rejected_request_is_parted_until_the_hole_is_found_and_the_rest_is_joined_again) {
  missing = {9};
  plan(registers({0, 2, 4, 6, 8, 10, 12, 14}));
  EXPECT_THAT(run(), ElementsAre("0+15!", "0+7", "8+7!", "8+3!", "8+1", "10+1", "12+3"));
  EXPECT_THAT(run(), ElementsAre("0+9", "10+5"));
  EXPECT_THAT(given_up, IsEmpty());
  EXPECT_EQ(cycle->status().front().requests, 2U);
}

TEST_F(RejectedRangesTest, A_hole_is_told_once_with_what_to_add_to_the_map) {
  missing = {9};
  plan(registers({0, 2, 8, 12}));
  run();
  const auto refusals = cycle->take_rejected_ranges();
  ASSERT_EQ(refusals.size(), 1U);
  EXPECT_THAT(to_string(refusals[0]),
              testing::HasSubstr("unreadable: [{table: holding_registers, from: 9, to: 11}]"));
  run();
  run();
  EXPECT_THAT(cycle->take_rejected_ranges(), IsEmpty());
}

TEST_F(RejectedRangesTest, Several_holes_are_found_in_one_cycle) {
  missing = {1, 11};
  plan(registers({0, 2, 4, 6, 8, 10, 12, 14}));
  run();
  EXPECT_THAT(run(), ElementsAre("0+1", "2+9", "12+3"));
  EXPECT_THAT(run(), Each(Not(testing::EndsWith("!"))));
}

TEST_F(RejectedRangesTest, A_point_that_is_refused_by_itself_is_given_up_and_the_rest_goes_on) {
  missing = {2};
  plan(registers({0, 1, 2, 3}));
  EXPECT_THAT(run(), ElementsAre("0+4!", "0+2", "2+2!", "2+1!", "3+1"));
  EXPECT_THAT(given_up, ElementsAre("holding_registers_2"));
  EXPECT_THAT(run(), ElementsAre("0+2", "3+1"));
  EXPECT_THAT(cycle->take_rejected_ranges(), IsEmpty()) << "the point has been told";
}

TEST_F(RejectedRangesTest, All_bits_of_a_refused_register_are_given_up_with_one_request) {
  missing = {0};
  MapBuilder builder;
  for (std::uint8_t bit = 0; bit < 3; ++bit)
    builder.add(holding, std::string("bit") + char('a' + bit), 0, codec::Type::BOOL,
                [bit](Point& point) { point.format.bit = bit; });
  plan(builder);
  EXPECT_THAT(run(), ElementsAre("0+1!"));
  EXPECT_THAT(given_up, ElementsAre("bita", "bitb", "bitc"));
  EXPECT_EQ(cycle->due(), Time::max());
}

TEST_F(RejectedRangesTest, A_program_that_only_looks_asks_for_a_rejected_area_once_in_each_cycle) {
  static const TableRange area[] = {{holding, modbus::Range::of(0, 10)}};
  missing = {5};
  MapBuilder builder = registers({1, 2, 3});
  builder.head().read_whole = area;
  plan(builder);
  cycle->only_look();
  cycle->start(now);
  for (int i = 0; i < 3; ++i) EXPECT_THAT(run(), ElementsAre("0+10!"));
}

TEST_F(RejectedRangesTest, A_device_that_takes_fewer_than_the_map_says_is_asked_for_less) {
  longest = 40;
  plan(MapBuilder().many(holding, 0, 100));
  EXPECT_THAT(run(), ElementsAre("0+100!", "0+50!", "0+25", "25+25", "50+50!", "50+25", "75+25"));
  EXPECT_THAT(run(), ElementsAre("0+25", "25+25", "50+25", "75+25"));
  const auto refusals = cycle->take_rejected_ranges();
  ASSERT_EQ(refusals.size(), 2U);
  EXPECT_THAT(to_string(refusals[0]), testing::HasSubstr("limits: {read_registers: ...}"));
}

TEST_F(RejectedRangesTest, A_function_that_the_device_does_not_know_is_not_tried_again) {
  plan(registers({0, 1}));
  cycle->select(now);
  cycle->give_up(now);
  EXPECT_EQ(cycle->due(), Time::max());
}

TEST_F(RejectedRangesTest, With_a_new_connection_everything_is_asked_for_again) {
  missing = {2};
  plan(registers({0, 1, 2, 3}));
  run();
  cycle->start(now);
  EXPECT_THAT(run(), Contains("0+4!"));
}

/// Points of every size, some over others, in a device that lacks some addresses and may take short requests
/// only.
struct RandomDeviceTest : RejectedRangesTest {
  void make(unsigned seed) {
    std::mt19937 random(seed);
    const auto below = [&random](unsigned limit) { return static_cast<unsigned>(random() % limit); };
    MapBuilder builder = registers({});
    builder.head().polling.register_gap = static_cast<std::uint16_t>(below(12));
    constexpr codec::Type types[] = {codec::Type::UINT, codec::Type::REAL, codec::Type::LREAL,
                                     codec::Type::SINT};
    const unsigned points = 1 + below(40);
    for (unsigned i = 0; i < points; ++i)
      builder.add(holding, "p" + std::to_string(i), static_cast<std::uint16_t>(below(150)), types[below(4)],
                  [&](Point& point) { point.host.rate = below(3) == 0 ? 1 : 0; });
    missing.clear();
    for (unsigned i = below(6); i > 0; --i) missing.insert(below(150));
    longest = below(2) == 0 ? 125 : 4 + below(20);
    given_up.clear();
    plan(builder);
  }
  /// Not one of its addresses is missing.
  bool has(const Point& point) const {
    const auto first = missing.lower_bound(range(point).start());
    return first == missing.end() || !range(point).contains(*first);
  }
  std::set<std::string> names(bool present) const {
    std::set<std::string> result;
    for (const Point& point : owned->map().points)
      if (has(point) == present) result.insert(std::string(point.name));
    return result;
  }
};

TEST_F(RandomDeviceTest, Exactly_what_the_device_has_is_read_and_soon_nothing_is_rejected) {
  for (unsigned seed = 0; seed < 500; ++seed) {
    SCOPED_TRACE(seed);
    make(seed);
    for (const Time end = now + std::chrono::seconds(4); now < end && cycle->due() < Time::max();) run();
    EXPECT_EQ(std::set<std::string>(given_up.begin(), given_up.end()), names(false));
    std::set<std::string> read;
    for (const Time end = now + std::chrono::seconds(1); now < end && cycle->due() < Time::max();) {
      const ReadSpan* span = cycle->select(now);
      if (span == nullptr) {
        now = cycle->due();
        continue;
      }
      for (const std::uint32_t point : span->points)
        read.insert(std::string(owned->map().points[point].name));
      EXPECT_THAT(step(), Not(testing::EndsWith("!")));
    }
    EXPECT_EQ(read, names(true));
    if (testing::Test::HasFailure()) return;
  }
}

}  // namespace
}  // namespace coupler::host
