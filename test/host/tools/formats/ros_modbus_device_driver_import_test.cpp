// SPDX-License-Identifier: Apache-2.0
// The samples are those of ros-modbus-device-driver: test/maps/origin (from its README, and its example).
#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "coupler/map/loader/load.hpp"
#include "test/host/tools/formats/imported.hpp"
#include "test/support/paths.hpp"

namespace coupler::test {
namespace {

using testing::HasSubstr;

std::string content(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST(RosModbusDeviceDriverImport, Its_files_keep_their_meaning) {
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(test::in_tree("test/maps/origin"))) {
    const LoadResult loaded = load_map_file(entry.path().string());
    ASSERT_NE(loaded.map, nullptr) << entry.path();
    const Imported imported("origin", content(entry.path()));
    ASSERT_EQ(imported.result.maps.size(), 1U) << imported.said;
    const Map& before = loaded.map->map();
    const Map& after = imported.result.maps[0].map->map();
    EXPECT_EQ(after.fingerprint, before.fingerprint);
    EXPECT_EQ(after.name, before.name);
    EXPECT_EQ(after.connection.address, before.connection.address);
    EXPECT_EQ(after.connection.unit, before.connection.unit);
    EXPECT_EQ(after.polling.rate, before.polling.rate);
    EXPECT_EQ(after.polling.discrete_continuous, before.polling.discrete_continuous);
    EXPECT_EQ(after.polling.register_gap, before.polling.register_gap);
    ++files;
  }
  EXPECT_EQ(files, 3);
}

TEST(RosModbusDeviceDriverImport, Comments_and_keys_that_nobody_knows_are_told_with_their_lines) {
  const Imported imported(
      "origin",
      "{\n  \"name\": \"a\", // a slave\n  \"colour\": \"red\",\n  \"register_read_separation_gap\": 5,\n"
      "  \"mapping\": {\"coils\": {\"x\": 1 /* one */}}\n}\n");
  EXPECT_EQ(imported.text(), "name: a\nregisters_read_separation_gap: 5\nmapping:\n  coils:\n    x: 1\n");
  EXPECT_THAT(imported.said, HasSubstr("given:2:16: warning: the comment is not carried over"));
  EXPECT_THAT(imported.said, HasSubstr("given:3:3: warning: "));
  EXPECT_THAT(imported.said, HasSubstr("given:5:32: warning: the comment is not carried over"));
}

TEST(RosModbusDeviceDriverImport, Comments_of_YAML_are_told_too) {
  const Imported imported("origin", "name: a  # the name\nmapping:\n# all\n  coils: {\"x\": 1}\n");
  EXPECT_THAT(imported.said, HasSubstr("given:1:10: warning: the comment"));
  EXPECT_THAT(imported.said, HasSubstr("given:3:1: warning: the comment"));
}

TEST(RosModbusDeviceDriverImport, A_file_with_a_unit_is_not_taken_for_another_one) {
  EXPECT_EQ(Imported("origin", "{name: a, unit: 4, mapping: {coils: {x: 1}}}", {"", 4}).result.maps.size(),
            1U);
  EXPECT_THAT(Imported("origin", "{name: a, unit: 4, mapping: {coils: {x: 1}}}", {"", 5}).said,
              HasSubstr("error: there is no unit 5 in the file; give one of 4 with --unit"));
}

}  // namespace
}  // namespace coupler::test
