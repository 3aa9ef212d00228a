// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>

#include "coupler/map/lookup_by_name.hpp"

namespace coupler {
namespace {

TEST(LookupByName, Each_is_found_in_whatever_order_they_are_asked_for) {
  std::array<std::string_view, 4> names{"a", "b", "c", "d"};
  LookupByName lookup(Span<std::string_view>(names), [](std::string_view name) { return name; });
  for (const std::size_t i : {0, 1, 3, 2, 3, 0, 0}) EXPECT_EQ(lookup.find(names[i]), &names[i]);
}

TEST(LookupByName, What_is_not_there_is_not_found_and_disturbs_nothing) {
  std::array<std::string_view, 2> names{"a", "b"};
  LookupByName lookup(Span<std::string_view>(names), [](std::string_view name) { return name; });
  EXPECT_EQ(lookup.find("a"), &names[0]);
  EXPECT_EQ(lookup.find("between"), nullptr);
  EXPECT_EQ(lookup.find("b"), &names[1]);
  EXPECT_EQ(lookup.find("behind"), nullptr);
}

}  // namespace
}  // namespace coupler
