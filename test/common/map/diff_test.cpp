// SPDX-License-Identifier: Apache-2.0
#include "coupler/map/diff.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "test/common/map/sample_points.hpp"

namespace coupler {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

std::vector<std::string> lines(const MapPtr& older, const MapPtr& newer) {
  std::vector<std::string> result;
  for (const Difference& difference : diff(older->map(), newer->map()))
    result.push_back(to_string(difference));
  return result;
}

Point& named(std::vector<Point>& points, std::string_view name) {
  return *std::find_if(points.begin(), points.end(), [&](const Point& p) { return p.name == name; });
}

TEST(Diff, Equal_maps_do_not_differ) {
  auto points = test::sample_points();
  const MapPtr map = test::map_of(points);
  named(points, "valve").description = "the left one";
  EXPECT_THAT(lines(map, test::map_of(points)), IsEmpty());
}

TEST(Diff, A_change_names_every_field) {
  auto points = test::sample_points();
  const MapPtr older = test::map_of(points);
  named(points, "speed").address = 17;
  named(points, "speed").format = {codec::Type::LREAL, codec::Order::ABCD};
  named(points, "ready").format.bit = 3;
  EXPECT_THAT(lines(older, test::map_of(points)),
              ElementsAre("~ ready: part bit15 -> bit3",
                          "~ speed: address 7 -> 17, type REAL -> LREAL, order CDAB -> ABCD"));
}

TEST(Diff, A_scale_reads_as_in_a_map) {
  auto points = test::sample_points();
  const MapPtr older = test::map_of(points);
  named(points, "speed").scale = {0.1, 0};
  const MapPtr newer = test::map_of(points);
  EXPECT_THAT(lines(older, newer), ElementsAre("~ speed: scale none -> 0.1"));
  named(points, "speed").scale = {0.1, -40};
  EXPECT_THAT(lines(newer, test::map_of(points)),
              ElementsAre("~ speed: scale 0.1 -> {gain: 0.1, offset: -40}"));
}

TEST(Diff, What_only_one_map_has_is_missing_or_added) {
  auto points = test::sample_points();
  const MapPtr older = test::map_of(points);
  named(points, "valve").name = "clamp";
  const MapPtr newer = test::map_of(points);
  EXPECT_THAT(lines(older, newer),
              ElementsAre("- valve: missing (coils 3, BOOL)", "+ clamp: added (coils 3, BOOL)"));
}

TEST(Diff, A_driver_may_know_a_subset) {
  auto points = test::sample_points();
  const MapPtr device = test::map_of(points);
  points.pop_back();
  const MapPtr known = test::map_of(points);
  EXPECT_TRUE(is_subset(known->map(), device->map()));
  EXPECT_TRUE(is_subset(device->map(), device->map()));
  EXPECT_FALSE(is_subset(device->map(), known->map()));
}

TEST(Diff, A_point_that_changed_is_no_part_of_a_subset) {
  auto points = test::sample_points();
  const MapPtr device = test::map_of(points);
  points.resize(1);
  points[0].format.length = 10;
  EXPECT_FALSE(is_subset(test::map_of(points)->map(), device->map()));
}

}  // namespace
}  // namespace coupler
