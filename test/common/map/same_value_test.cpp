// SPDX-License-Identifier: Apache-2.0
#include "coupler/map/same_value.hpp"

#include <functional>

#include <gtest/gtest.h>

namespace coupler {
namespace {

Point some_text() {
  Point point;
  point.name = "text";
  point.table = Table::holding_registers;
  point.format.type = codec::Type::STRING;
  point.format.length = 8;
  return point;
}

bool is_same_after(const std::function<void(Point&)>& change) {
  Point other = some_text();
  change(other);
  return same_value(some_text(), other);
}

TEST(SameValue, Names_addresses_and_what_the_host_does_do_not_matter) {
  EXPECT_TRUE(is_same_after([](Point& p) { p.name = "other"; }));
  EXPECT_TRUE(is_same_after([](Point& p) { p.address = 100; }));
  EXPECT_TRUE(is_same_after([](Point& p) { p.access = Access::read_write; }));
  EXPECT_TRUE(is_same_after([](Point& p) { p.host.rate = 5; }));
}

TEST(SameValue, All_that_registers_mean_matters) {
  EXPECT_FALSE(is_same_after([](Point& p) { p.table = Table::input_registers; }));
  EXPECT_FALSE(is_same_after([](Point& p) { p.count = 2; }));
  EXPECT_FALSE(is_same_after([](Point& p) { p.format.type = codec::Type::WORD; }));
  EXPECT_FALSE(is_same_after([](Point& p) { p.format.order = codec::Order::BADC; }));
  EXPECT_FALSE(is_same_after([](Point& p) { p.format.bit = 1; }));
  EXPECT_FALSE(is_same_after([](Point& p) { p.format.half = codec::Half::low; }));
  EXPECT_FALSE(is_same_after([](Point& p) { p.format.length = 9; }));
  EXPECT_FALSE(is_same_after([](Point& p) { p.format.encoding = codec::Encoding::latin1; }));
  EXPECT_FALSE(is_same_after([](Point& p) { p.scale.gain = 0.1; }));
  EXPECT_FALSE(is_same_after([](Point& p) { p.scale.offset = 1; }));
}

}  // namespace
}  // namespace coupler
