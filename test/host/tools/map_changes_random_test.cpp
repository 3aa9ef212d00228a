// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "coupler/map/diff.hpp"
#include "coupler/map/loader/load.hpp"
#include "coupler/tools/map_changes.hpp"
#include "test/fakes/random_map.hpp"

namespace coupler::tools {
namespace {

MapPtr loaded(const fakes::RandomMap& map) { return load_map(map.yaml(), "random.yaml").map; }

TEST(RandomMap, Is_valid_and_the_same_for_the_same_seed) {
  for (std::uint32_t seed = 0; seed < 200; ++seed) {
    const fakes::RandomMap map(seed);
    const LoadResult result = load_map(map.yaml(), "random.yaml");
    ASSERT_TRUE(result.map) << seed << "\n" << map.yaml() << to_string(result.diagnostics.front());
    EXPECT_EQ(map.yaml(), fakes::RandomMap(seed).yaml());
  }
}

TEST(Changes, Of_200_random_edits_those_are_breaking_that_the_check_at_connect_refuses) {
  int edits = 0;
  int refused = 0;
  for (std::uint32_t seed = 1000; edits < 200; ++seed) {
    ASSERT_LT(seed, 2000U) << "too few edits leave a valid map";
    fakes::RandomMap map(seed);
    const MapPtr older = loaded(map);
    ASSERT_TRUE(older) << seed;
    const std::string what = map.edit();
    const MapPtr newer = loaded(map);
    if (!newer) continue;
    ++edits;
    const bool breaking = worst(compare(older->map(), newer->map())) == Severity::breaking;
    EXPECT_EQ(breaking, !is_subset(older->map(), newer->map())) << "seed " << seed << ": " << what;
    if (older->map().fingerprint == newer->map().fingerprint) {
      EXPECT_FALSE(breaking) << "seed " << seed << ": " << what;
    }
    refused += breaking ? 1 : 0;
  }
  EXPECT_GT(refused, 40) << "the edits say little";
  EXPECT_LT(refused, 160) << "the edits say little";
}

}  // namespace
}  // namespace coupler::tools
