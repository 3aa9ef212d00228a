// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/core/publish_policy.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "coupler/codec/number.hpp"
#include "test/host/core/fake_clock.hpp"

namespace coupler::host {
namespace {

using namespace std::chrono_literals;

struct PublishPolicyTest : testing::Test {
  PublishPolicyTest() {
    point.table = Table::holding_registers;
    point.format.type = codec::Type::INT;
    point.host.publish = HostOptions::Publish::on_change;
  }
  bool calls_news(std::vector<std::uint16_t> registers) {
    return policy().calls_news(registers.data(), clock.now());
  }
  bool calls_real_news(float value) {
    std::uint16_t registers[2];
    codec::encode(value, point.format.order, registers);
    return policy().calls_news(registers, clock.now());
  }
  PublishPolicy& policy() {
    if (!made) made.emplace(point);
    return *made;
  }

  Point point;
  test::FakeClock clock;
  std::optional<PublishPolicy> made;
};

TEST_F(PublishPolicyTest, Always_every_value_is_news) {
  point.host.publish = HostOptions::Publish::always;
  EXPECT_TRUE(calls_news({5}));
  EXPECT_TRUE(calls_news({5}));
}

TEST_F(PublishPolicyTest, On_change_the_first_value_is_news_and_then_only_another_one) {
  EXPECT_TRUE(calls_news({0}));
  EXPECT_FALSE(calls_news({0}));
  EXPECT_TRUE(calls_news({1}));
  EXPECT_FALSE(calls_news({1}));
}

TEST_F(PublishPolicyTest, The_other_bits_of_a_shared_register_are_not_its_own) {
  point.format.type = codec::Type::BOOL;
  point.format.bit = 3;
  EXPECT_TRUE(calls_news({0x0008}));
  EXPECT_FALSE(calls_news({0xFFFF}));
  EXPECT_TRUE(calls_news({0xFFF7}));
}

TEST_F(PublishPolicyTest, Each_element_of_an_array_counts) {
  point.count = 3;
  EXPECT_TRUE(calls_news({1, 2, 3}));
  EXPECT_FALSE(calls_news({1, 2, 3}));
  EXPECT_TRUE(calls_news({1, 2, 4}));
}

TEST_F(PublishPolicyTest, Within_the_deadband_of_the_last_news_nothing_is_news) {
  point.host.deadband = 2;
  EXPECT_TRUE(calls_news({10}));
  EXPECT_FALSE(calls_news({12}));
  EXPECT_FALSE(calls_news({8}));
  EXPECT_TRUE(calls_news({13}));
  EXPECT_FALSE(calls_news({11}));
}

TEST_F(PublishPolicyTest, A_slow_drift_is_news_once_it_leaves_the_deadband) {
  point.host.deadband = 2;
  int news = 0;
  for (std::uint16_t value = 0; value < 10; ++value) news += calls_news({value}) ? 1 : 0;
  EXPECT_EQ(news, 4) << "0, 3, 6, 9";
}

TEST_F(PublishPolicyTest, The_deadband_is_in_published_units) {
  point.host.deadband = 0.5;
  point.scale.gain = -0.1;
  EXPECT_TRUE(calls_news({100}));
  EXPECT_FALSE(calls_news({104}));
  EXPECT_TRUE(calls_news({107}));
}

TEST_F(PublishPolicyTest, A_change_from_or_to_no_number_leaves_every_deadband) {
  point.format.type = codec::Type::REAL;
  point.host.deadband = 1;
  EXPECT_TRUE(calls_real_news(1.0F));
  EXPECT_TRUE(calls_real_news(std::nanf("")));
  EXPECT_FALSE(calls_real_news(std::nanf("1"))) << "another NaN says nothing new";
  EXPECT_TRUE(calls_real_news(std::numeric_limits<float>::infinity()));
  EXPECT_TRUE(calls_real_news(1.0F));
}

TEST_F(PublishPolicyTest, After_the_longest_interval_the_same_value_is_news) {
  point.host.max_interval = 1s;
  EXPECT_TRUE(calls_news({7}));
  clock.advance(999ms);
  EXPECT_FALSE(calls_news({7}));
  clock.advance(1ms);
  EXPECT_TRUE(calls_news({7}));
  clock.advance(999ms);
  EXPECT_FALSE(calls_news({7}));
}

TEST_F(PublishPolicyTest, Renewed_the_same_value_is_news_once) {
  EXPECT_TRUE(calls_news({7}));
  policy().renew();
  EXPECT_TRUE(calls_news({7}));
  EXPECT_FALSE(calls_news({7}));
}

TEST_F(PublishPolicyTest, Another_power_of_ten_makes_another_value) {
  point.scale.exponent_of = "sf";
  EXPECT_TRUE(calls_news({5, 0}));
  EXPECT_FALSE(calls_news({5, 0}));
  EXPECT_TRUE(calls_news({5, 1}));
}

TEST_F(PublishPolicyTest, A_deadband_is_of_the_value_with_its_power_of_ten) {
  point.scale.exponent_of = "sf";
  point.host.deadband = 10;
  EXPECT_TRUE(calls_news({500, 0}));
  EXPECT_FALSE(calls_news({51, 1})) << "500 and 510";
  EXPECT_TRUE(calls_news({5, 3}));
  EXPECT_TRUE(calls_news({5, static_cast<std::uint16_t>(-2)}));
}

}  // namespace
}  // namespace coupler::host
