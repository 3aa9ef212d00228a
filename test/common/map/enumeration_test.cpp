// SPDX-License-Identifier: Apache-2.0
#include "coupler/base/enumeration.hpp"

#include <gtest/gtest.h>

#include "coupler/map/map.hpp"

namespace coupler {
namespace {

static_assert(JoinedWords<Bias>::text() == "none|pull_up|pull_down");
static_assert(JoinedWords<codec::Encoding>::text() == "utf-8|ascii|latin-1");

TEST(Enumeration, What_a_map_says_is_read_and_shown_again) {
  EXPECT_EQ(parse_word<Bias>("pull_up"), Bias::pull_up);
  EXPECT_EQ(to_string(Bias::pull_up), "pull_up");
  EXPECT_EQ(parse_word<codec::Encoding>("latin-1"), codec::Encoding::latin1);
  EXPECT_EQ(codec::to_string(codec::Encoding::latin1), "latin-1");
}

TEST(Enumeration, What_a_map_cannot_say_is_shown_by_its_name_and_not_read) {
  EXPECT_EQ(to_string(Bias::as_is), "as_is");
  EXPECT_EQ(parse_word<Bias>("as_is"), std::nullopt);
  EXPECT_EQ(parse_word<Bias>(""), std::nullopt);
  EXPECT_EQ(parse_word<Bias>("pull"), std::nullopt);
}

TEST(Enumeration, A_value_with_two_words_is_shown_by_the_first) {
  EXPECT_EQ(parse_word<codec::Order>("BA"), codec::Order::BADC);
  EXPECT_EQ(codec::to_string(codec::Order::BADC), "BADC");
}

}  // namespace
}  // namespace coupler
