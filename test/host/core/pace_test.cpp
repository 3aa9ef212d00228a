// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/core/pace.hpp"

#include <gmock/gmock.h>

#include "test/fakes/map_builder.hpp"

namespace coupler::host {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

struct PaceTest : testing::Test {
  PaceTest() { now.online = true; }
  /// Lets `seconds` pass, with so many cycles in each.
  std::vector<std::string> pass(int seconds, int done, int left_out) {
    std::vector<std::string> warnings;
    for (int i = 0; i < seconds; ++i) {
      for (int k = 0; k < done; ++k) now.cycles.add(1ms);
      now.overruns += static_cast<std::uint64_t>(left_out);
      at += 1s;
      if (auto warning = pace.update(owned->map(), now, at)) warnings.push_back(*warning);
    }
    return warnings;
  }

  MapPtr owned = make();
  static MapPtr make() {
    auto builder = fakes::MapBuilder().holding("a", 0);
    builder.head().polling.rate = 50;
    return builder.build();
  }
  DeviceSnapshot now;
  Time at{};
  Pace pace;
};

TEST_F(PaceTest, A_slow_device_is_warned_of_once_with_the_rate_that_it_can_do) {
  const auto warnings = pass(60, 6, 44);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_THAT(warnings[0], HasSubstr("too slow for 'rate: 50', or this computer is busy: its points are read "
                                     "about 6 times a second"));
  EXPECT_THAT(warnings[0], HasSubstr("set 'rate: 6'"));
  EXPECT_EQ(pace.trouble(), warnings[0]);
}

TEST_F(PaceTest, Large_rates_are_told_without_an_exponent) {
  auto builder = fakes::MapBuilder().holding("a", 0);
  builder.head().polling.rate = 2000;
  owned = builder.build();
  const auto warnings = pass(60, 477, 1523);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_THAT(warnings[0], HasSubstr("read about 480 times a second; set 'rate: 477'"));
}

TEST_F(PaceTest, A_cycle_that_is_left_out_now_and_then_is_no_trouble) {
  EXPECT_TRUE(pass(60, 45, 5).empty());
  EXPECT_EQ(pace.trouble(), "");
}

TEST_F(PaceTest, It_is_warned_of_again_only_after_a_minute_without_trouble) {
  EXPECT_EQ(pass(30, 6, 44).size(), 1U);
  EXPECT_TRUE(pass(40, 50, 0).empty());
  EXPECT_TRUE(pass(30, 6, 44).empty()) << "it is the same trouble";
  EXPECT_NE(pace.trouble(), "");
  pass(80, 50, 0);
  EXPECT_EQ(pace.trouble(), "");
  EXPECT_EQ(pass(30, 6, 44).size(), 1U);
}

TEST_F(PaceTest, While_it_is_offline_nothing_is_counted) {
  pass(5, 6, 44);
  now.online = false;
  EXPECT_TRUE(pass(60, 0, 0).empty());
  now.online = true;
  EXPECT_TRUE(pass(9, 6, 44).empty());
}

}  // namespace
}  // namespace coupler::host
