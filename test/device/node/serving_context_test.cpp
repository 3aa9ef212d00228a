// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "coupler/device/node/serving_context.hpp"
#include "test/fakes/map_builder.hpp"

namespace coupler::device {
namespace {

using codec::Type;
using fakes::MapBuilder;
using testing::HasSubstr;
using testing::Not;

TEST(Servable, Points_in_the_identity_area_are_refused_by_name) {
  const auto map = MapBuilder()
                       .add(Table::input_registers, "fine", 0xFEFF, Type::WORD)
                       .add(Table::input_registers, "inside", 0xFF00, Type::WORD)
                       .add(Table::holding_registers, "across", 0xFEFF, Type::DWORD)
                       .build();
  const auto servable = check_servable(map->map());
  ASSERT_FALSE(servable.has_value());
  EXPECT_THAT(servable.error(), HasSubstr("point 'inside': input_registers 65280"));
  EXPECT_THAT(servable.error(), HasSubstr("point 'across': holding_registers 65279"));
  EXPECT_THAT(servable.error(), Not(HasSubstr("'fine'")));
}

TEST(Servable, Bits_may_be_anywhere) {
  const auto map =
      MapBuilder().many(Table::coils, 0xFF00, 256).many(Table::discrete_inputs, 0xFF00, 256).build();
  EXPECT_TRUE(check_servable(map->map()).has_value());
}

}  // namespace
}  // namespace coupler::device
