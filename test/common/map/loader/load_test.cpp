// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <unistd.h>

#include <filesystem>
#include <fstream>

#include <fmt/format.h>

#include "coupler/map/fingerprint.hpp"
#include "test/common/map/loader/loaded.hpp"
#include "test/support/paths.hpp"

namespace coupler {
namespace {

TEST(Load, The_map_keeps_its_text_as_it_was_read) {
  const std::string text =
      "{ \"name\": \"press\", // a comment\r\n\"mapping\": {\"coils\": {\"valve\": 0,}}}";
  const MapPtr owned = test::load_clean(text);
  EXPECT_EQ(owned->map().text, text);
  EXPECT_EQ(owned->map().text_crc, crc32(text));
}

TEST(Load, Points_are_in_the_order_of_the_fingerprint) {
  const MapPtr owned = test::load_clean(
      "name: press\n"
      "mapping:\n"
      "  holding_registers: {speed: {address: 0, type: INT}}\n"
      "  coils: {lamp: 7, valve: 3}\n");
  const auto points = owned->map().points;
  ASSERT_EQ(points.size(), 3U);
  EXPECT_EQ(points[0].name, "valve");
  EXPECT_EQ(points[1].name, "lamp");
  EXPECT_EQ(points[2].name, "speed");
  EXPECT_EQ(owned->map().fingerprint, fingerprint(points));
}

TEST(Load, The_line_of_a_point_is_where_its_name_stands) {
  const LoadResult result = load_map(
      "name: press\n"
      "mapping:\n"
      "  holding_registers:\n"
      "    speed: {address: 0, type: INT}\n"
      "  coils:\n"
      "    lamp: 7\n"
      "    valve:\n"
      "      address: 3\n",
      "map.yaml");
  EXPECT_EQ(result.point_lines, (std::vector<int>{7, 6, 4})) << "as the points: valve, lamp, speed";
  EXPECT_TRUE(load_map("name: press\nmapping: {coils: {a: -1}}\n", "map.yaml").point_lines.empty());
}

TEST(Load, An_empty_table_beside_others_is_no_mistake) {
  EXPECT_EQ(test::load_clean("name: press\nmapping:\n  coils: {valve: 0}\n  discrete_inputs: {}\n")
                ->map()
                .points.size(),
            1U);
}

TEST(Load, A_map_without_points_is_an_error_unless_a_node_serves_it) {
  for (const char* mapping : {"mapping:", "mapping: {}", "mapping: {coils: , discrete_inputs: {}}"}) {
    const std::string text = std::string("name: press\n") + mapping + '\n';
    EXPECT_TRUE(has_errors(load_map(text, "map.yaml").diagnostics)) << mapping;
    EXPECT_NE(load_served_map(text, "map.yaml").map, nullptr) << mapping;
  }
}

TEST(Load, What_a_node_serves_may_have_keys_that_are_near_to_ours_or_stand_elsewhere) {
  const LoadResult served = load_served_map(
      "name: press\nwatchdgo: {timeout: 1s}\nmapping: {coils: {valve: {address: 0, scael: 1, port: 1}}}\n",
      "m");
  ASSERT_NE(served.map, nullptr) << test::text_of(served.diagnostics);
  EXPECT_EQ(served.diagnostics.size(), 3U);
}

TEST(Load, What_a_node_says_of_being_asked_for_its_identity_does_not_count) {
  const std::string text = "name: press\nverify: off\nmapping: {coils: {valve: 0}}\n";
  EXPECT_EQ(load_map(text, "m").map->map().verify, Verify::off);
  EXPECT_EQ(load_served_map(text, "m").map->map().verify, Verify::require);
}

TEST(Load, A_bare_timeout_of_more_than_a_minute_is_refused_in_files_only) {
  const std::string text = "name: press\ntimeout: 61\nmapping: {coils: {valve: 0}}\n";
  EXPECT_EQ(load_map(text, "m").map, nullptr);
  EXPECT_NE(load_served_map(text, "m").map, nullptr) << "an older node may have it";
  EXPECT_NE(load_map("name: press\ntimeout: 60\nmapping: {coils: {valve: 0}}\n", "m").map, nullptr);
}

TEST(Load, Names_may_have_parts) {
  const MapPtr owned =
      test::load_clean("name: hall/press_2\nmapping: {coils: {arm/left: 0, arm/right: 1}}\n");
  EXPECT_EQ(owned->map().name, "hall/press_2");
  EXPECT_NE(find(owned->map(), "arm/left"), nullptr);
}

TEST(Load, An_input_may_be_called_like_the_write_topic_of_another_input) {
  const MapPtr owned = test::load_clean("name: press\nmapping: {discrete_inputs: {pen: 0, pen/write: 1}}\n");
  EXPECT_EQ(owned->map().points.size(), 2U);
}

TEST(Load, Problems_come_in_the_order_of_the_file) {
  const LoadResult result = load_map(
      "name: 1\n"
      "mapping:\n"
      "  holding_registers: {a: 0}\n"
      "  coils: {b: -1, b: 2}\n"
      "port: 0\n",
      "map");
  ASSERT_EQ(result.diagnostics.size(), 5U) << test::text_of(result.diagnostics);
  for (std::size_t i = 1; i < result.diagnostics.size(); ++i)
    EXPECT_LE(result.diagnostics[i - 1].line, result.diagnostics[i].line);
  EXPECT_EQ(result.map, nullptr);
}

TEST(Load, A_node_may_serve_a_map_with_keys_of_a_later_version) {
  const std::string text =
      "name: press\nmood: good\nmapping: {coils: {valve: {address: 0, line: GPIO4, hue: 3, debounce: "
      "5ms}}}\n";
  EXPECT_FALSE(load_map(text, "map.yaml").map);
  const LoadResult served = load_served_map(text, "map.yaml");
  ASSERT_TRUE(served.map);
  EXPECT_EQ(served.map->map().points[0].name, "valve");
  ASSERT_EQ(served.diagnostics.size(), 3U);
  EXPECT_EQ(served.diagnostics[0].what, "unknown key 'mood' of the map, ignored");
  for (const Diagnostic& diagnostic : served.diagnostics) EXPECT_EQ(diagnostic.remedy, "");
  EXPECT_FALSE(load_served_map("name: press\nmapping: {coils: {valve: 70000}}\n", "map.yaml").map);
}

TEST(Load, A_file_that_cannot_be_read_is_a_diagnostic) {
  const LoadResult missing = load_map_file("/no/such/map.yaml");
  EXPECT_EQ(missing.map, nullptr);
  EXPECT_EQ(test::text_of(missing.diagnostics),
            "/no/such/map.yaml: error: the file cannot be read: No such file or directory; give the path of "
            "a map\n");
  EXPECT_EQ(
      test::text_of(load_map_file(test::in_tree("test")).diagnostics),
      test::in_tree("test") + ": error: the file cannot be read: Is a directory; give the path of a map\n");
}

TEST(Load, A_file_that_is_not_there_is_answered_with_one_of_almost_its_name) {
  namespace fs = std::filesystem;
  const fs::path folder = fs::temp_directory_path() / fmt::format("near-{}", getpid());
  fs::create_directory(folder);
  for (const char* name : {"tx8.yaml", "press_line.yml", "tx8.txt", "belt.yaml.lock"})
    std::ofstream(folder / name) << "name: p\n";
  const auto remedy_for = [&](const char* name) {
    return load_map_file((folder / name).string()).diagnostics.at(0).remedy;
  };
  const auto meant = [&](const char* name) {
    return fmt::format("did you mean {}?", (folder / name).string());
  };
  EXPECT_EQ(remedy_for("tx8.yml"), meant("tx8.yaml"));
  EXPECT_EQ(remedy_for("tx8.json"), meant("tx8.yaml"));
  EXPECT_EQ(remedy_for("tx8"), meant("tx8.yaml"));
  EXPECT_EQ(remedy_for("pres_line.yml"), meant("press_line.yml"));
  EXPECT_EQ(remedy_for("belt.yaml"), "give the path of a map");
  fs::remove_all(folder);
}

TEST(Load, A_device_is_refused_since_it_may_have_no_end) {
  EXPECT_EQ(to_string(load_map_file("/dev/zero").diagnostics.at(0)),
            "/dev/zero: error: it is a device, not a file; give the path of a map, or - for standard input");
}

TEST(Load, A_file_that_is_too_long_is_refused) {
  const auto path = std::filesystem::temp_directory_path() / fmt::format("long-{}.yaml", ::getpid());
  std::ofstream(path).close();
  std::filesystem::resize_file(path, max_file_size + 1);
  const LoadResult result = load_map_file(path.string());
  std::filesystem::remove(path);
  EXPECT_EQ(
      to_string(result.diagnostics.at(0)),
      path.string() + ": error: the file has more than 16 MiB, but a map may not; give the path of a map");
}

TEST(Load, A_json_map_may_name_its_schema) {
  const auto result =
      load_map(R"({"$schema": "map.schema.json", "name": "m", "mapping": {"coils": {"a": 0}}})", "m.json");
  EXPECT_TRUE(result.map);
  EXPECT_TRUE(result.diagnostics.empty());
}

}  // namespace
}  // namespace coupler
