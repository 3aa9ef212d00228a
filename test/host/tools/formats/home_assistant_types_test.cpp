// SPDX-License-Identifier: Apache-2.0
// Types, sizes and swaps are those of homeassistant/components/modbus: validators.py and entity.py.
#include <gmock/gmock.h>

#include "test/host/tools/formats/imported.hpp"

namespace coupler::test {
namespace {

using testing::HasSubstr;
using testing::Not;

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
      {"input_type: input, data_type: string, count: 4", "type: STRING, length: 8, order: AB}"},
      {"input_type: input, data_type: string, count: 4, swap: byte", "type: STRING, length: 8}"},
      {"input_type: input, data_type: int16, virtual_count: 3", "type: INT, count: 4}"},
  };
  for (const auto& [keys, point] : all)
    EXPECT_THAT(sensor(keys).text(), HasSubstr(std::string("    s: {address: 3, ") + point)) << keys;
  EXPECT_THAT(sensor("data_type: float16").said, HasSubstr("warning: the map has no type for 'float16'"));
  EXPECT_THAT(sensor("data_type: real").said, HasSubstr("error: 'real' is not a data type; write int16"));
  EXPECT_THAT(sensor("swap: words").said, HasSubstr("error: 'words' is not a swap"));
}

// The letters, sizes and prefixes are those of Python's module struct.
TEST(HomeAssistantImport, A_structure_is_a_point_for_each_of_its_values) {
  const std::pair<const char*, const char*> all[] = {
      {"1, structure: \">xB\"", "s: {address: 3, type: USINT, offset: low}"},
      {"1, structure: \">bx\"", "s: {address: 3, type: SINT, offset: high}"},
      {"3, structure: \">3H\"", "s: {address: 3, type: UINT, count: 3}"},
      {"2, structure: \"<I\"", "s: {address: 3, type: UDINT, order: DCBA}"},
      {"2, structure: \">4s\"", "s: {address: 3, type: STRING, length: 4, order: AB}"},
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

// OLD_DATA_TYPES in validators.py of 2021 to 2023: one register if `count` is not there.
TEST(HomeAssistantImport, A_type_of_old_versions_has_its_width_from_count) {
  const std::pair<const char*, const char*> all[] = {
      {"data_type: int", "type: INT}"},
      {"data_type: int, count: 2", "type: DINT, order: ABCD}"},
      {"data_type: uint, count: 1", "type: UINT}"},
      {"data_type: uint, count: 4, swap: word", "type: ULINT, order: CDAB}"},
      {"data_type: float, count: 2", "type: REAL, order: ABCD}"},
      {"data_type: float, count: 4", "type: LREAL, order: ABCD}"},
      {"data_type: int32, count: 2", "type: DINT, order: ABCD}"},
  };
  for (const auto& [keys, point] : all)
    EXPECT_THAT(sensor(std::string("input_type: input, ") + keys).text(),
                HasSubstr(std::string("    s: {address: 3, ") + point))
        << keys;
  EXPECT_THAT(sensor("data_type: float").said, HasSubstr("warning: the map has no type for 'float16'"));
  EXPECT_THAT(
      sensor("data_type: uint, count: 3").said,
      HasSubstr("error: 'count' is 3, but 'uint' has 1, 2 or 4 registers; correct it, or write uint16, "
                "uint32 or uint64 without 'count'"));
}

TEST(HomeAssistantImport, A_count_that_contradicts_the_type_is_refused) {
  EXPECT_THAT(
      sensor("data_type: int32, count: 3").said,
      HasSubstr("error: 'count' is 3, but int32 has 2 registers; remove 'count', or correct 'data_type'"));
  EXPECT_THAT(sensor("count: 2").said, HasSubstr("error: 'count' is 2, but int16 has 1 register;"));
}

// It became `swap: word` in 2021.4.
TEST(HomeAssistantImport, Reverse_order_of_old_versions_is_a_swap_of_words) {
  const Imported imported = sensor("input_type: input, data_type: int32, reverse_order: true");
  EXPECT_THAT(imported.text(), HasSubstr("s: {address: 3, type: DINT, order: CDAB}"));
  EXPECT_THAT(imported.said, Not(HasSubstr("reverse_order")));
  EXPECT_THAT(sensor("input_type: input, data_type: int32, reverse_order: false").text(),
              HasSubstr("type: DINT, order: ABCD}"));
  EXPECT_THAT(
      sensor("data_type: int32, reverse_order: true, swap: byte").said,
      HasSubstr("error: 'reverse_order' means 'swap: word', but 'swap' is byte; remove one of the two"));
  EXPECT_THAT(sensor("data_type: int32, reverse_order: 7").said,
              HasSubstr("error: 'reverse_order' is neither true nor false; write true or false"));
}

// The registers are swapped, then unpacked: entity.py, _swap_registers().
TEST(HomeAssistantImport, A_swap_of_a_structure_of_one_number_is_in_its_order) {
  const std::pair<const char*, const char*> all[] = {
      {"2, swap: word, structure: \">f\"", "type: REAL, order: CDAB}"},
      {"2, swap: byte, structure: \">f\"", "type: REAL, order: BADC}"},
      {"2, swap: word_byte, structure: \"!i\"", "type: DINT, order: DCBA}"},
      {"2, swap: word, structure: \"<I\"", "type: UDINT, order: BADC}"},
      {"2, swap: byte, structure: \"<f\"", "type: REAL, order: CDAB}"},
      {"4, swap: word, structure: \">d\"", "type: LREAL, order: CDAB}"},
      {"4, swap: word_byte, structure: \"<q\"", "type: LINT, order: ABCD}"},
      {"1, swap: byte, structure: \">h\"", "type: INT, order: BA}"},
      {"1, swap: byte, structure: \"<h\"", "type: INT}"},
  };
  for (const auto& [keys, point] : all)
    EXPECT_THAT(sensor(std::string("input_type: input, data_type: custom, count: ") + keys).text(),
                HasSubstr(std::string("    s: {address: 3, ") + point))
        << keys;
}

TEST(HomeAssistantImport, What_a_swap_takes_apart_is_left_out_and_told) {
  for (const char* keys : {"4, swap: word, structure: \">ff\"", "2, swap: byte, structure: \">2h\"",
                           "3, swap: word, structure: \">fxx\"", "1, swap: byte, structure: \">xB\""})
    EXPECT_THAT(
        sensors("{name: t, address: 9}, {name: s, address: 3, data_type: custom, count: " +
                std::string(keys) + "}")
            .said,
        HasSubstr("is left out: 'swap' changes the registers of more than one number; make each value "
                  "an entity of its own, with 'data_type' and 'swap'"))
        << keys;
  EXPECT_THAT(sensor("data_type: string, count: 2, swap: word").said,
              HasSubstr("warning: a text whose registers are reversed is left out"));
}

// PyYAML's rules of YAML 1.1; what it does not take for a number is one to Python's int().
TEST(HomeAssistantImport, A_number_with_a_zero_before_it_is_octal) {
  const Imported octal = Imported(
      "home-assistant",
      "modbus: {name: h, type: tcp, host: 10.0.0.7, port: 502, sensors: [{name: s, address: 010}]}\n");
  EXPECT_THAT(octal.text(), HasSubstr("s: {address: 8, "));
  EXPECT_THAT(octal.said,
              HasSubstr("warning: 010 is an octal number in Home Assistant's YAML, so it is read as "
                        "8; write 8, or the number that is meant without a zero before it"));
  for (const auto& [given, address] : {std::pair("08", 8), std::pair("\"010\"", 10), std::pair("0x10", 16)}) {
    const Imported decimal =
        Imported("home-assistant",
                 "modbus: {name: h, type: tcp, host: 10.0.0.7, port: 502, sensors: [{name: "
                 "s, address: " +
                     std::string(given) + "}]}\n");
    EXPECT_THAT(decimal.text(), HasSubstr("s: {address: " + std::to_string(address) + ", "));
    EXPECT_THAT(decimal.said, Not(HasSubstr("octal")));
  }
  EXPECT_THAT(sensor("input_type: input, scale: 010").text(), HasSubstr("scale: 8}"));
}

TEST(HomeAssistantImport, A_sensors_scale_and_units_are_the_points) {
  EXPECT_THAT(
      sensor("input_type: input, scale: 0.1, offset: -40, unit_of_measurement: \"°C\", precision: 1").text(),
      HasSubstr("s: {address: 3, type: INT, scale: {gain: 0.1, offset: -40}, units: \"°C\"}"));
  EXPECT_THAT(sensor("input_type: input, scale: 0.5").text(), HasSubstr("type: INT, scale: 0.5}"));
}

}  // namespace
}  // namespace coupler::test
