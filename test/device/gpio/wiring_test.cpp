// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "coupler/device/gpio/wiring.hpp"
#include "test/device/core/fake_log.hpp"
#include "test/fakes/map_builder.hpp"

namespace coupler::device {
namespace {

using fakes::MapBuilder;
using testing::HasSubstr;

TEST(PreparedWiring, A_map_without_lines_needs_no_hardware) {
  FakeLog log;
  const auto map = MapBuilder().many(Table::coils, 0, 4).build();
  EXPECT_TRUE(prepare_wiring(map->map(), false, nullptr, false, log).has_value());
}

TEST(PreparedWiring, A_chip_that_does_not_exist_is_named_with_its_point_and_the_simulation_does_without) {
  FakeLog log;
  const auto map =
      MapBuilder()
          .add(Table::coils, "lamp", 0, codec::Type::BOOL, [](Point& p) { p.line.chip = "no-such-chip"; })
          .build();
  const auto lines = prepare_wiring(map->map(), false, nullptr, false, log);
  ASSERT_FALSE(lines.has_value());
  EXPECT_THAT(lines.error(), HasSubstr("point 'lamp'"));
  EXPECT_THAT(lines.error(), HasSubstr("--sim"));
  EXPECT_TRUE(prepare_wiring(map->map(), true, nullptr, false, log).has_value());
}

}  // namespace
}  // namespace coupler::device
