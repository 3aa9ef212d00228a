// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "coupler/host/core/poll_cycle.hpp"
#include "test/fakes/map_builder.hpp"

namespace coupler::host::test {

/// A cycle, and a device in which some addresses are missing and every request takes its time.
struct PollCycleTest : testing::Test {
  void plan(fakes::MapBuilder builder) {
    owned = builder.build();
    cycle.emplace(owned->map());
    cycle->start(now);
  }

  /// One request, if one is due: "0+4", with a "!" if it was rejected.
  std::string step() {
    const ReadSpan* span = cycle->select(now);
    if (span == nullptr) return {};
    auto text = fmt::format("{}+{}", span->range.start(), span->range.count());
    now += reply_time;
    bool good = span->range.count() <= longest;
    for (std::uint32_t i = 0; i < span->range.count(); ++i)
      good = good && missing.count(span->range.start() + i) == 0;
    if (good) {
      cycle->answered(std::nullopt, now);
      return text;
    }
    for (const std::uint32_t point : cycle->rejected(now))
      given_up.push_back(std::string(owned->map().points[point].name));
    return text + "!";
  }
  /// Everything that is due, then to the next deadline.
  std::vector<std::string> run() {
    std::vector<std::string> requests;
    while (cycle->due() <= now) {
      const std::string request = step();
      if (!request.empty()) requests.push_back(request);
    }
    if (cycle->due() < Time::max()) now = cycle->due();
    return requests;
  }
  /// The requests of each of `count` steps.
  std::vector<std::string> steps(int count) {
    std::vector<std::string> requests;
    for (int i = 0; i < count; ++i) requests.push_back(step());
    return requests;
  }

  static constexpr Time begin = Time{} + std::chrono::hours(1);
  Time now = begin;
  Duration reply_time = std::chrono::milliseconds(1);
  std::uint32_t longest = 125;
  std::set<std::uint32_t> missing;
  std::vector<std::string> given_up;
  MapPtr owned;
  std::optional<PollCycle> cycle;
};

/// A map of UINT registers that may be read across.
inline fakes::MapBuilder registers(std::initializer_list<unsigned> addresses) {
  fakes::MapBuilder builder;
  for (const unsigned address : addresses) builder.many(Table::holding_registers, address, 1);
  builder.head().polling.register_continuous = true;
  return builder;
}

}  // namespace coupler::host::test
