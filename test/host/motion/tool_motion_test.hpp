// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "coupler/host/motion/tool_motion.hpp"

#include <chrono>
#include <optional>
#include <string>

#include <gtest/gtest.h>

#include "test/host/motion/sample_tools.hpp"

namespace coupler::host {

/// Time is in milliseconds.
struct ToolMotionTest : testing::Test {
  static Time at(int ms) { return Time(std::chrono::milliseconds(ms)); }

  void use(const Tool& tool) { motion.emplace(tool, at(0)); }
  void see(int ms, ToolPart part, bool on) {
    motion->see(part, on, {at(ms), std::chrono::milliseconds(0)}, at(ms));
  }
  /// The command that is to be given: "close on"; "" if there is none.
  std::string command() {
    const auto given = motion->take_command();
    if (!given) return {};
    number = given->number;
    return std::string(given->output == ToolPart::close ? "close" : "open") + (given->on ? " on" : " off");
  }
  void acknowledge(int ms) { motion->on_written(number, {}, at(ms)); }
  /// The goal has come, and its output is driven at that time.
  void drive(ToolEnd end, int ms) {
    motion->begin(end, at(ms));
    while (!command().empty()) acknowledge(ms);
    motion->take_asked();
  }
  /// The result, which is the only one: "" if there is none.
  std::string text() {
    const auto results = motion->take_results();
    if (results.empty()) return {};
    EXPECT_EQ(results.size(), 1U);
    how = results.front().how;
    return results.front().text;
  }
  ToolState state() const { return motion->status().state; }

  std::optional<ToolMotion> motion{std::in_place, clamp(), Time()};
  std::uint64_t number = 0;
  ToolResult::How how = ToolResult::How::aborted;
};

}  // namespace coupler::host
