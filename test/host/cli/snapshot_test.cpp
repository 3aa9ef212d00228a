// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/cli/snapshot.hpp"

#include <gtest/gtest.h>

#include "test/fakes/map_builder.hpp"

namespace coupler::cli {
namespace {

using Kind = modbus::Change::Kind;
using State = Reading::State;

struct TakeChange : testing::Test {
  TakeChange() {
    owned = fakes::MapBuilder()
                .coil("lamp", 3)
                .add(Table::coils, "row", 8, codec::Type::BOOL, [](Point& point) { point.count = 4; })
                .input("door", 3)
                .build();
    now.readings = {{0, State::good, {0}}, {1, State::good, {0, 0, 0, 0}}, {2, State::failed, {}, "silent"}};
  }
  bool take(int table, int address, Kind kind) {
    return take_change(
        owned->map(), {static_cast<std::uint8_t>(table), kind, static_cast<std::uint16_t>(address), {}}, now);
  }
  MapPtr owned;
  Snapshot now;
};

TEST_F(TakeChange, A_bit_is_put_into_the_reading_that_has_it_which_alone_is_marked) {
  now.readings[0].changed = true;
  EXPECT_TRUE(take(1, 10, Kind::on));
  EXPECT_EQ(now.readings[1].registers, (std::vector<std::uint16_t>{0, 0, 1, 0}));
  EXPECT_TRUE(now.readings[1].changed);
  EXPECT_FALSE(now.readings[0].changed);
}

TEST_F(TakeChange, A_level_that_it_has_already_is_none) {
  EXPECT_TRUE(take(1, 3, Kind::on));
  EXPECT_FALSE(take(1, 3, Kind::on));
  EXPECT_TRUE(take(1, 3, Kind::off));
}

TEST_F(TakeChange, A_point_that_was_not_read_and_one_of_another_table_stay_as_they_are) {
  EXPECT_FALSE(take(2, 3, Kind::on));
  EXPECT_TRUE(now.readings[2].registers.empty());
  EXPECT_EQ(now.readings[0].registers, std::vector<std::uint16_t>{0});
  EXPECT_FALSE(take(1, 100, Kind::on));
}

}  // namespace
}  // namespace coupler::cli
