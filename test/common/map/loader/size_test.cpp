// SPDX-License-Identifier: Apache-2.0
// Large and hostile files end in time: what is quadratic takes minutes, and CTest's limit is one.
#include <fmt/format.h>
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

TEST(Size, A_map_in_one_line_is_read_as_fast_as_in_many) {
  std::string text = R"({"name": "press", "mapping": {"holding_registers": {)";
  for (int i = 0; i < 30000; ++i)
    text += (i > 0 ? ", " : "") + fmt::format(R"("p{}": {{"address": {}, "type": "INT"}})", i, i);
  EXPECT_EQ(problems(text + "}}}"), 0U);
}

TEST(Size, Sixteen_megabytes_of_brackets_and_commas_are_refused_before_they_are_parsed) {
  constexpr std::size_t many = 15'000'000;  // yaml-cpp would take 3.5 GB
  for (const std::string_view part : {"[", "[\n", "{a: ", "- ", ","}) {
    const std::string text = (part == "," ? "[" : "a: ") + repeated(part, many / part.size());
    const auto found = load_map(text, "map").diagnostics;
    ASSERT_EQ(found.size(), 1U) << part;
    const std::string& what = found.front().what;
    EXPECT_TRUE(what.find("nested too deep") != std::string::npos || what.find("parts") != std::string::npos)
        << what;
  }
}

TEST(Size, Brackets_of_prose_are_not_nesting) {
  EXPECT_EQ(problems(registers(100,
                               [](const std::string& i) {
                                 return "p" + i + ": {address: " + i +
                                        ", type: INT, description: 'see [1'}\n    # [[[ {{";
                               })),
            0U);
  EXPECT_EQ(problems(registers(100,
                               [](const std::string& i) {
                                 return "p" + i + ":\n      address: " + i +
                                        "\n      type: INT\n      description: see [1";
                               })),
            0U);
}

TEST(Size, A_point_may_have_a_name_for_each_number) {
  std::string text =
      "name: press\nmapping:\n  holding_registers:\n    mode:\n      address: 0\n      type: UDINT\n"
      "      values:\n";
  for (int i = 0; i < 40000; ++i) text += fmt::format("        {}: n{}\n", i, i);
  EXPECT_EQ(problems(text), 0U);
}

}  // namespace
}  // namespace coupler
