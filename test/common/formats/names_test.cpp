// SPDX-License-Identifier: Apache-2.0
#include "coupler/formats/names.hpp"

#include <gtest/gtest.h>

#include "coupler/map/loader/names.hpp"

namespace coupler::formats {
namespace {

TEST(MendedName, Keeps_letters_digits_and_inner_slashes_and_joins_the_rest_by_one_underscore) {
  EXPECT_EQ(mended_name("Motor 1 - speed (rpm)", "p"), "Motor_1_speed_rpm");
  EXPECT_EQ(mended_name("axis/x", "p"), "axis/x");
  EXPECT_EQ(mended_name("/axis//x/", "p"), "axis/x");
  EXPECT_EQ(mended_name("K\xC3\xBChler", "p"), "K_hler");
}

TEST(MendedName, Gets_the_prefix_where_it_would_begin_with_something_else_than_a_letter) {
  EXPECT_EQ(mended_name("4711", "p"), "p_4711");
  EXPECT_EQ(mended_name("", "p"), "p");
  EXPECT_EQ(mended_name("%%%", "p"), "p");
}

TEST(MendedName, Is_a_valid_name_whatever_it_was) {
  std::string text;
  for (int first = 0; first < 256; ++first)
    for (int second = 0; second < 256; second += 5) {
      text = {static_cast<char>(first), static_cast<char>(second), '/', static_cast<char>(first)};
      ASSERT_TRUE(loader::is_relative_ros_name(mended_name(text, "p"))) << first << ' ' << second;
    }
  EXPECT_TRUE(loader::is_relative_ros_name(mended_name(std::string(5000, 'x') + "/", "p")));
}

}  // namespace
}  // namespace coupler::formats
