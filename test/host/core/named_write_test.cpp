// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/core/named_write.hpp"

#include <gmock/gmock.h>

#include "test/fakes/map_builder.hpp"

namespace coupler::host {
namespace {

using testing::HasSubstr;

struct NamedWrite : testing::Test {
  std::string error_of(std::string_view name, std::string_view text) const {
    const auto write = write_named(owned->map(), name, text);
    return write ? "" : write.error();
  }

  MapPtr owned = fakes::MapBuilder("cell")
                     .coil("lamp", 0)
                     .input("door", 0)
                     .holding("level", 3, codec::Type::INT)
                     .build();
};

TEST_F(NamedWrite, It_has_the_points_number_and_the_values_registers) {
  const auto write = write_named(owned->map(), "level", "-2");
  ASSERT_TRUE(write) << write.error();
  EXPECT_EQ(owned->map().points[write->point].name, "level");
  EXPECT_EQ(write->registers[0], 0xFFFE);
  EXPECT_TRUE(write_named(owned->map(), "lamp", "true")->bit(0));
}

TEST_F(NamedWrite, A_point_that_is_not_there_is_told_with_the_one_that_was_meant) {
  EXPECT_EQ(error_of("lmap", "true"), "there is no point 'lmap' in the map of cell; did you mean 'lamp'?");
  EXPECT_EQ(error_of("pressure", "1"),
            "there is no point 'pressure' in the map of cell; the map has their names");
  EXPECT_EQ(point_named(owned->map(), "Door").error(),
            "there is no point 'Door' in the map of cell; did you mean 'door'?");
}

TEST_F(NamedWrite, What_cannot_be_written_says_why) {
  EXPECT_EQ(error_of("door", "true"),
            "door cannot be written: it is an input; coils and holding registers can be");
  EXPECT_THAT(error_of("level", "full"), HasSubstr("is not a number"));
}

}  // namespace
}  // namespace coupler::host
