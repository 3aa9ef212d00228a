// SPDX-License-Identifier: Apache-2.0
// What holds for every importer.
#include "coupler/tools/formats/importers.hpp"

#include <gmock/gmock.h>

#include <random>
#include <set>

#include "coupler/map/loader/names.hpp"
#include "test/host/tools/formats/imported.hpp"

namespace coupler::test {
namespace {

using formats::mended_name;
using testing::HasSubstr;

TEST(Import, Every_format_has_a_name_of_its_own_and_is_found_by_it) {
  std::set<std::string_view> names;
  for (const formats::Importer& importer : formats::importers()) {
    EXPECT_TRUE(names.insert(importer.name).second);
    EXPECT_EQ(formats::find_importer(importer.name), &importer);
    EXPECT_FALSE(importer.summary.empty());
  }
  EXPECT_EQ(formats::find_importer("winmodbus"), nullptr);
}

TEST(Import, A_map_without_a_name_gets_the_files) {
  const auto result = formats::import_text(*formats::find_importer("csv"), "table,name,address\ncoils,a,0\n",
                                           "/tmp/Line 4.v2.csv", {});
  ASSERT_EQ(result.maps.size(), 1U);
  EXPECT_EQ(result.maps[0].map->map().name, "Line_4_v2");
  EXPECT_EQ(result.maps[0].text.substr(0, result.maps[0].text.find('\n')),
            "# Imported from Line 4.v2.csv by `coupler import csv`.");
}

TEST(Import, A_unit_that_the_file_does_not_know_is_set) {
  EXPECT_THAT(Imported("csv", "table,name,address\ncoils,a,0\n", {"x", 17}).text(), HasSubstr("unit: 17\n"));
}

TEST(Import, Bytes_that_are_no_text_are_refused_by_every_format) {
  for (const formats::Importer& importer : formats::importers()) {
    if (!importer.is_table) {  // which may be of any encoding
      EXPECT_THAT(Imported(importer.name, "table,\xFF").said,
                  HasSubstr("given:1:7: error: byte 0xFF is not UTF-8"));
    }
    EXPECT_THAT(Imported(importer.name, std::string("a\0b", 3)).said,
                HasSubstr("given:1:2: error: control character"));
  }
}

TEST(Import, A_line_of_100_MB_is_refused_by_every_format) {
  const std::string line(100U << 20U, 'x');
  for (const formats::Importer& importer : formats::importers())
    EXPECT_THAT(Imported(importer.name, line).said, HasSubstr("error: the file has 104857600 bytes"));
}

TEST(Import, A_broken_file_is_a_map_that_loads_or_an_error_whatever_is_broken) {
  const std::string good =
      "table,name,address,type,scale,initial\nholding_registers,a b,1,INT,\"{gain: "
      "2}\",4\n\"coils\",c,5,,,on\n";
  const std::string json =
      "{\"mode\": \"RTU\", \"port\": {\"name\": \"COM1\", \"stopBits\": 1}, \"slaves\": {\"1\": "
      "{\"isOnline\": true, \"registers\": {\"HR0\": 1, \"C5\": "
      "true}}}}";
  const std::string xml =
      "<modbuspal_project><links selected=\"Serial\"><serial com=\"COM1\" stops=\"1\"/></links><slave "
      "id=\"1\"><coils><coil address=\"0\" "
      "name=\"x\"/></coils></slave></modbuspal_project>";
  const std::string yaml =
      "modbus:\n - name: h\n   type: serial\n   port: !secret x\n   parity: N\n   sensors:\n    - &s {name: "
      "s, "
      "address: 3, count: 1, slave: !secret u, "
      "data_type: custom, structure: \">xB\"}\n    - {<<: *s, address: 4}\n   switches:\n   - {name: t, "
      "slave: !secret u, address: 3, verify: {address: "
      "4}}\n";
  const std::string simulator =
      "{\"setup\": {\"co size\": 9, \"di size\": 9, \"ir size\": 9, \"hr size\": 9, \"shared blocks\": "
      "true}, "
      "\"write\": [3], \"uint16\": [3, [5, 7]], \"repeat\": [{\"addr\": [3, 4], \"to\": [1, 2]}]}";
  std::mt19937 random(1);  // NOLINT: the same every time
  constexpr std::string_view bytes = "{}[]\"',;:<>&*/\\\n\t 0a-#!";
  for (int round = 0; round < 3000; ++round) {
    for (const formats::Importer& importer : formats::importers()) {
      std::string text = importer.name == "csv"              ? good
                         : importer.name == "modbuspal"      ? xml
                         : importer.name == "home-assistant" ? yaml
                         : importer.name == "pymodbus"       ? simulator
                                                             : json;
      for (int change = 0; change < 3; ++change)
        text[random() % text.size()] = bytes[random() % bytes.size()];
      if (round % 3 == 0) text.resize(random() % text.size());
      const Imported imported(importer.name, text);
      ASSERT_EQ(imported.result.maps.empty(), has_errors(imported.result.diagnostics))
          << text << imported.said;
    }
  }
}

TEST(MendedName, Keeps_letters_digits_and_inner_slashes_and_joins_the_rest_by_one_underscore) {
  EXPECT_EQ(mended_name("Motor 1 - speed (rpm)", "p"), "Motor_1_speed_rpm");
  EXPECT_EQ(mended_name("axis/x", "p"), "axis/x");
  EXPECT_EQ(mended_name("/axis//x/", "p"), "axis/x");
  EXPECT_EQ(mended_name("K\xC3\xBChler", "p"), "kuehler");
}

TEST(MendedName, Gets_the_prefix_where_it_would_begin_with_something_else_than_a_letter) {
  EXPECT_EQ(mended_name("4711", "p"), "p_4711");
  EXPECT_EQ(mended_name("", "p"), "p");
  EXPECT_EQ(mended_name("%%%", "p"), "p");
}

TEST(MendedName, Is_a_valid_name_whatever_it_was) {
  std::string text;
  for (int first = 0; first < 256; ++first)
    for (int second = 0; second < 256; second += 5) {
      text = {static_cast<char>(first), static_cast<char>(second), '/', static_cast<char>(first)};
      ASSERT_TRUE(loader::is_relative_ros_name(mended_name(text, "p"))) << first << ' ' << second;
    }
  EXPECT_TRUE(loader::is_relative_ros_name(mended_name(std::string(5000, 'x') + "/", "p")));
}

}  // namespace
}  // namespace coupler::test
