// SPDX-License-Identifier: Apache-2.0
// Large and hostile files end in time: what is quadratic takes minutes, and CTest's limit is one.
#include <gtest/gtest.h>

#include "test/common/map/loader/loaded.hpp"

namespace coupler {
namespace {

std::string repeated(std::string_view text, std::size_t times) {
  std::string result;
  for (std::size_t i = 0; i < times; ++i) result += text;
  return result;
}

/// `points` is called with each number to write a point.
template <class F>
std::string registers(std::size_t count, F&& point) {
  std::string text = "name: press\nmapping:\n  holding_registers:\n";
  for (std::size_t i = 0; i < count; ++i) text += "    " + point(std::to_string(i)) + "\n";
  return text;
}

std::size_t problems(const std::string& text) { return load_map(text, "map").diagnostics.size(); }

TEST(Size, Ten_thousand_good_points_load) {
  EXPECT_EQ(problems(registers(10000,
                               [](const std::string& i) {
                                 return "p" + i + ": {address: " + i +
                                        ", type: INT, units: mm, description: a point, initial: 1}";
                               })),
            0U);
}

TEST(Size, Ten_thousand_points_in_one_place_are_each_reported_once) {
  EXPECT_EQ(
      problems(registers(
          10000, [](const std::string& i) { return "p" + i + ": {address: 0, type: STRING, length: 200}"; })),
      9999U);
}

TEST(Size, Ten_thousand_unknown_keys_are_each_reported) {
  EXPECT_EQ(problems(registers(10000,
                               [](const std::string& i) {
                                 return "p" + i + ": {address: " + i +
                                        ", type: INT, registers_read_separation: 1, order: AB}";
                               })),
            10000U);
}

TEST(Size, Ten_thousand_points_of_one_name_are_each_reported) {
  EXPECT_EQ(problems(registers(10000,
                               [](const std::string& i) { return "same: {address: " + i + ", type: INT}"; })),
            9999U);
}

TEST(Size, Deep_nesting_is_refused) {
  for (const std::string_view open : {"[", "{a: ", "- ", "? ", "{\"a\": [", "!x ", "&a ", "\""}) {
    EXPECT_GE(problems(repeated(open, 20000)), 1U) << open;
    EXPECT_GE(problems("name: " + repeated(open, 20000)), 1U) << open;
  }
}

TEST(Size, A_bomb_of_aliases_is_refused) {
  std::string bomb = "a: &a [x, x]\n";
  for (char name = 'b'; name <= 'z'; ++name) {
    const char before = static_cast<char>(name - 1);
    bomb += std::string(1, name) + ": &" + name + " [*" + before + ", *" + before + "]\n";
  }
  EXPECT_EQ(problems(bomb), 1U);
}

TEST(Size, A_file_above_the_limit_is_refused_unread) {
  EXPECT_EQ(problems(std::string((std::size_t{16} << 20U) + 1, ' ')), 1U);
}

}  // namespace
}  // namespace coupler
