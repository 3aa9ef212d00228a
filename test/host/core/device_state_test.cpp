// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/core/device_state.hpp"

#include <fstream>
#include <iterator>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "test/support/paths.hpp"

namespace coupler::host {
namespace {

TEST(DeviceState, The_table_in_the_docs_is_that_of_the_code) {
  std::string table = "| state |";
  for (const auto& event : enumeration_of<DeviceEvent>.words) table += fmt::format(" {} |", event.word);
  table += "\n|---|---|---|---|---|---|\n";
  for (const auto& state : enumeration_of<DeviceState>.words) {
    table += fmt::format("| {} |", state.word);
    for (const auto& event : enumeration_of<DeviceEvent>.words)
      table += fmt::format(" {} |", coupler::to_string(after(state.value, event.value)));
    table += "\n";
  }
  std::ifstream file(coupler::test::in_tree("docs/architecture.md"));
  const std::string page{std::istreambuf_iterator<char>(file), {}};
  EXPECT_NE(page.find(table), std::string::npos) << table;
}

TEST(DeviceState, Without_a_connection_nothing_but_a_new_one_counts) {
  for (const auto& event : enumeration_of<DeviceEvent>.words) {
    const auto wanted = event.value == DeviceEvent::connected ? DeviceState::open : DeviceState::closed;
    EXPECT_EQ(after(DeviceState::closed, event.value), wanted) << event.word;
  }
}

}  // namespace
}  // namespace coupler::host
