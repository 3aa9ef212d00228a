// SPDX-License-Identifier: Apache-2.0
// Types, sizes and swaps are those of homeassistant/components/modbus: validators.py and entity.py.
#include <gmock/gmock.h>

#include "test/common/formats/imported.hpp"

namespace coupler::test {
namespace {

using testing::HasSubstr;

Imported sensors(const std::string& list) {
  return Imported("home-assistant",
                  "modbus: {name: h, type: tcp, host: 10.0.0.7, port: 502, sensors: [" + list + "]}\n");
}

Imported sensor(const std::string& keys) { return sensors("{name: s, address: 3, " + keys + "}"); }

TEST(HomeAssistantImport, A_data_type_and_its_swap_are_a_type_and_its_order) {
  const std::pair<const char*, const char*> all[] = {
      {"input_type: input", "type: INT}"},
      {"input_type: input, data_type: uint16, swap: byte", "type: UINT, order: BA}"},
      {"input_type: input, data_type: int32", "type: DINT, order: ABCD}"},
      {"input_type: input, data_type: uint32, swap: word", "type: UDINT, order: CDAB}"},
      {"input_type: input, data_type: int64, swap: byte", "type: LINT, order: BADC}"},
      {"input_type: input, data_type: uint64, swap: word_byte", "type: ULINT, order: DCBA}"},
      {"input_type: input, data_type: float32, swap: none", "type: REAL, order: ABCD}"},
      {"input_type: input, data_type: float64", "type: LREAL, order: ABCD}"},
      {"input_type: input, data_type: string, count: 4", "type: STRING, length: 8, ignore_byteorder: true}"},
      {"input_type: input, data_type: string, count: 4, swap: byte", "type: STRING, length: 8}"},
      {"input_type: input, data_type: int16, virtual_count: 3", "type: INT, count: 4}"},
  };
  for (const auto& [keys, point] : all)
    EXPECT_THAT(sensor(keys).text(), HasSubstr(std::string("    s: {address: 3, ") + point)) << keys;
  EXPECT_THAT(sensor("data_type: float16").said, HasSubstr("warning: the map has no type for 'float16'"));
  EXPECT_THAT(sensor("data_type: float").said, HasSubstr("error: 'float' is not a data type; write int16"));
  EXPECT_THAT(sensor("swap: words").said, HasSubstr("error: 'words' is not a swap"));
}

// The letters, sizes and prefixes are those of Python's module struct.
TEST(HomeAssistantImport, A_structure_is_a_point_for_each_of_its_values) {
  const std::pair<const char*, const char*> all[] = {
      {"1, structure: \">xB\"", "s: {address: 3, type: USINT, offset: low}"},
      {"1, structure: \">bx\"", "s: {address: 3, type: SINT, offset: high}"},
      {"3, structure: \">3H\"", "s: {address: 3, type: UINT, count: 3}"},
      {"2, structure: \"<I\"", "s: {address: 3, type: UDINT, order: DCBA}"},
      {"2, structure: \">4s\"", "s: {address: 3, type: STRING, length: 4, ignore_byteorder: true}"},
      {"5, structure: \">hxBxxf\"",
       "s_0: {address: 3, type: INT}\n    s_1: {address: 4, type: USINT, offset: low}\n"
       "    s_2: {address: 6, type: REAL, order: ABCD}"},
  };
  for (const auto& [keys, points] : all)
    EXPECT_THAT(sensor(std::string("input_type: input, data_type: custom, count: ") + keys).text(),
                HasSubstr(points))
        << keys;
}

TEST(HomeAssistantImport, A_structure_that_no_point_can_hold_is_left_out_and_told) {
  const std::pair<const char*, const char*> all[] = {
      {"1, structure: \"h\"", "its byte order is that of the computer"},
      {"2, structure: \">h\"", "it has 2 bytes, but 'count' is 2 registers"},
      {"1, structure: \">e\"", "the map has no type for 'e'"},
      {"2, structure: \">xhx\"", "a value begins in the middle of a register"},
      {"1, structure: \">xx\"", "it holds no value"},
      {"1, structure: \">99999h\"", "it is not one of Python's module struct"},
  };
  for (const auto& [keys, why] : all)
    EXPECT_THAT(sensors("{name: t, address: 9}, {name: s, address: 3, data_type: custom, count: " +
                        std::string(keys) + "}")
                    .said,
                HasSubstr(why))
        << keys;
  EXPECT_THAT(sensor("data_type: custom, count: 1").said,
              HasSubstr("error: 'data_type: custom' has no 'structure'"));
}

TEST(HomeAssistantImport, A_sensors_scale_and_units_are_the_points) {
  EXPECT_THAT(
      sensor("input_type: input, scale: 0.1, offset: -40, unit_of_measurement: \"°C\", precision: 1").text(),
      HasSubstr("s: {address: 3, type: INT, scale: {gain: 0.1, offset: -40}, units: \"°C\"}"));
  EXPECT_THAT(sensor("input_type: input, scale: 0.5").text(), HasSubstr("type: INT, scale: 0.5}"));
}

}  // namespace
}  // namespace coupler::test
