// SPDX-License-Identifier: Apache-2.0
// Large and hostile files end in time. The bounds are generous: what is quadratic takes minutes.
#include <gtest/gtest.h>

#include <chrono>

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

std::size_t problems_within_bound(const std::string& text) {
  const auto start = std::chrono::steady_clock::now();
  const std::size_t problems = load_map(text, "map").diagnostics.size();
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(20));
  return problems;
}

TEST(Size, Ten_thousand_good_points_load) {
  EXPECT_EQ(
      problems_within_bound(registers(10000,
                                      [](const std::string& i) {
                                        return "p" + i + ": {address: " + i +
                                               ", type: INT, units: mm, description: a point, initial: 1}";
                                      })),
      0U);
}

TEST(Size, Ten_thousand_points_in_one_place_are_each_reported_once) {
  EXPECT_EQ(
      problems_within_bound(registers(
          10000, [](const std::string& i) { return "p" + i + ": {address: 0, type: STRING, length: 200}"; })),
      9999U);
}

TEST(Size, Ten_thousand_unknown_keys_are_each_reported) {
  EXPECT_EQ(problems_within_bound(registers(10000,
                                            [](const std::string& i) {
                                              return "p" + i + ": {address: " + i +
                                                     ", type: INT, registers_read_separation: 1, order: AB}";
                                            })),
            10000U);
}

TEST(Size, Ten_thousand_points_of_one_name_are_each_reported) {
  EXPECT_EQ(problems_within_bound(registers(
                10000, [](const std::string& i) { return "same: {address: " + i + ", type: INT}"; })),
            9999U);
}

TEST(Size, Deep_nesting_is_refused) {
  for (const std::string_view open : {"[", "{a: ", "- ", "? ", "{\"a\": [", "!x ", "&a ", "\""}) {
    EXPECT_GE(problems_within_bound(repeated(open, 200000)), 1U) << open;
    EXPECT_GE(problems_within_bound("name: " + repeated(open, 200000)), 1U) << open;
  }
}

TEST(Size, A_bomb_of_aliases_is_refused) {
  std::string bomb = "a: &a [x, x]\n";
  for (char name = 'b'; name <= 'z'; ++name) {
    const char before = static_cast<char>(name - 1);
    bomb += std::string(1, name) + ": &" + name + " [*" + before + ", *" + before + "]\n";
  }
  EXPECT_EQ(problems_within_bound(bomb), 1U);
}

TEST(Size, A_file_above_the_limit_is_refused_unread) {
  EXPECT_EQ(problems_within_bound(std::string((std::size_t{16} << 20U) + 1, ' ')), 1U);
}

}  // namespace
}  // namespace coupler
