// SPDX-License-Identifier: Apache-2.0
#include "coupler/tools/formats/exporters.hpp"

#include <gmock/gmock.h>

#include <filesystem>

#include "coupler/map/loader/load.hpp"
#include "test/host/tools/formats/imported.hpp"
#include "test/support/paths.hpp"

namespace coupler::test {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> maps_of_the_tree() {
  std::vector<fs::path> files;
  const fs::path root = test::in_tree("");
  for (const auto* folder : {"config", "config/presets", "test/maps", "test/maps/origin", "test/generate",
                             "test/peers", "test/kernel", "test/attack"})
    for (const auto& entry : fs::directory_iterator(root / folder))
      if (entry.path().extension() == ".yaml" || entry.path().extension() == ".json")
        files.push_back(entry.path());
  return files;
}

TEST(CsvExport, A_map_that_goes_through_a_table_and_back_has_the_same_fingerprint) {
  int maps = 0;
  for (const fs::path& file : maps_of_the_tree()) {
    const LoadResult loaded = load_map_file(file.string());
    if (!loaded.map) continue;  // presets are half a map
    const Map& map = loaded.map->map();
    const formats::Export out = formats::write_csv(map);
    const Imported back("csv", out.text, {std::string(map.name), {}});
    ASSERT_EQ(back.result.maps.size(), 1U) << file << '\n' << back.said << out.text;
    EXPECT_EQ(back.result.maps[0].map->map().fingerprint, map.fingerprint) << file << '\n' << out.text;
    const Map& again = back.result.maps[0].map->map();
    for (std::size_t i = 0; i < map.points.size(); ++i) {
      const Point& a = map.points[i];
      const Point& b = again.points[i];
      EXPECT_TRUE(std::equal(a.initial.begin(), a.initial.end(), b.initial.begin(), b.initial.end()))
          << a.name;
      if (is_readable(a)) {
        EXPECT_EQ(a.host.rate, b.host.rate) << a.name;
      }
      EXPECT_EQ(a.host.deadman.timeout, b.host.deadman.timeout) << a.name;
      EXPECT_EQ(a.safe, b.safe) << a.name;
      EXPECT_TRUE(
          std::equal(a.safe_value.begin(), a.safe_value.end(), b.safe_value.begin(), b.safe_value.end()))
          << a.name;
      EXPECT_EQ(a.line.name, b.line.name) << a.name;
      EXPECT_EQ(a.line.chip, b.line.chip) << a.name;
      EXPECT_EQ(a.description, b.description);
    }
    ++maps;
  }
  EXPECT_GE(maps, 10);
}

TEST(CsvExport, Orders_and_addresses_are_written_out_whatever_the_map_counts_in) {
  const LoadResult loaded = load_map(
      "{name: m, addressing: modicon, wordorder_reverse: true, mapping: {holding_registers: {\n"
      "  a: {address: 40011, type: REAL}, b: {address: 40013, type: SINT, offset: low}}}}",
      "m");
  ASSERT_NE(loaded.map, nullptr);
  EXPECT_EQ(formats::write_csv(loaded.map->map()).text,
            "table,name,address,type,order,access,units,description,offset\r\n"
            "holding_registers,a,10,REAL,ABCD,,,,\r\n"
            "holding_registers,b,12,SINT,,,,,low\r\n");
}

TEST(CsvExport, What_the_driver_leaves_behind_goes_through_a_table_and_back) {
  const LoadResult loaded = load_map(
      "{name: m, on_shutdown: safe, mapping: {\n"
      "  coils: {car: {address: 4, count: 3, safe: [on, off, on]}, lamp: {address: 8, safe: hold}, horn: "
      "9},\n"
      "  holding_registers: {speed: {address: 0, type: INT, scale: 0.5, safe: 12}}}}",
      "m");
  ASSERT_NE(loaded.map, nullptr) << lines_of(loaded.diagnostics);
  const formats::Export out = formats::write_csv(loaded.map->map());
  EXPECT_THAT(lines_of(out.warnings.diagnostics("m")), testing::Not(testing::HasSubstr("on_shutdown")));
  const Imported back("csv", out.text, {"m", {}});
  ASSERT_EQ(back.result.maps.size(), 1U) << back.said << out.text;
  EXPECT_EQ(back.said,
            "given:2:18: warning: 'safe' of a point without a line, 'iio' or 'pwm' is the value that the "
            "driver writes when it ends, so the map has 'on_shutdown: safe'; empty these cells if the driver "
            "should leave outputs as they are\n");
  const Map& again = back.result.maps[0].map->map();
  EXPECT_EQ(again.fingerprint, loaded.map->map().fingerprint);
  EXPECT_EQ(again.on_shutdown, OnShutdown::safe);
  const Point& car = *find(again, "car");
  EXPECT_EQ(std::vector<std::uint16_t>(car.safe_value.begin(), car.safe_value.end()),
            (std::vector<std::uint16_t>{1, 0, 1}));
  EXPECT_EQ(find(again, "lamp")->safe, Safe::hold);
  EXPECT_EQ(find(again, "horn")->safe, Safe::off);
  EXPECT_EQ(find(again, "speed")->safe_value[0], 24);
}

TEST(CsvExport, Where_the_wiring_alone_has_safe_states_the_drivers_manners_are_told) {
  const LoadResult loaded = load_map(
      "{name: m, on_shutdown: safe, mapping: {coils: {a: {address: 0, line: GPIO4, safe: on}}}}", "m");
  ASSERT_NE(loaded.map, nullptr);
  const formats::Export out = formats::write_csv(loaded.map->map());
  EXPECT_THAT(lines_of(out.warnings.diagnostics("m")), testing::HasSubstr("left out: name, on_shutdown;"));
  const Imported back("csv", out.text, {"m", {}});
  EXPECT_EQ(back.said, "");
  ASSERT_EQ(back.result.maps.size(), 1U);
  EXPECT_EQ(back.result.maps[0].map->map().on_shutdown, OnShutdown::hold);
}

TEST(CsvExport, Texts_that_a_spreadsheet_would_run_are_kept_from_it_and_numbers_are_not) {
  const LoadResult loaded = load_map(
      "{name: m, mapping: {holding_registers: {a: {address: 0, type: INT, initial: -5, description: "
      "'=cmd()'}, b: {address: 1, type: STRING, length: 4, initial: '-x'}}}}",
      "m");
  ASSERT_NE(loaded.map, nullptr) << lines_of(loaded.diagnostics);
  const std::string table = formats::write_csv(loaded.map->map()).text;
  EXPECT_THAT(table, testing::HasSubstr(",'=cmd(),,-5\r\n")) << table;
  EXPECT_THAT(table, testing::HasSubstr(",'-x\r\n")) << table;
  const Imported back("csv", table, {"m", {}});
  ASSERT_EQ(back.result.maps.size(), 1U) << back.said << table;
  const Map& again = back.result.maps[0].map->map();
  EXPECT_EQ(again.points[0].description, "=cmd()");
  EXPECT_EQ(again.points[1].initial[0], 0x782D);  // the low byte first
}

TEST(CsvExport, The_devices_own_keys_are_told) {
  const LoadResult loaded = load_map("{name: m, port: 503, mapping: {coils: {a: 0}}}", "m");
  ASSERT_NE(loaded.map, nullptr);
  EXPECT_THAT(lines_of(formats::write_csv(loaded.map->map()).warnings.diagnostics("m.yaml")),
              testing::HasSubstr(
                  "m.yaml: warning: the table has points only, the device's keys are left out: name, port;"));
}

}  // namespace
}  // namespace coupler::test
