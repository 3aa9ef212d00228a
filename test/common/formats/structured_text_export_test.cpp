// SPDX-License-Identifier: Apache-2.0
// How the file looks, and what is told. That it means the right thing is proved by test/plc, on another's
// parser.
#include <gmock/gmock.h>

#include "coupler/formats/exporters.hpp"
#include "coupler/map/loader/load.hpp"
#include "test/common/formats/imported.hpp"

namespace coupler::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

formats::Export exported(const std::string& points, const std::string& top = "name: m") {
  const LoadResult loaded = load_map("{" + top + ", mapping: {" + points + "}}", "m");
  EXPECT_NE(loaded.map, nullptr) << lines_of(loaded.diagnostics);
  return loaded.map ? formats::write_structured_text(loaded.map->map()) : formats::Export{};
}

std::string told(const std::string& points) { return lines_of(exported(points).warnings.diagnostics("m")); }

TEST(StructuredTextExport, A_value_is_declared_with_its_type_where_it_is_and_what_it_means) {
  EXPECT_THAT(
      exported(
          "coils: {lamps: {address: 8, count: 3}}, input_registers: {"
          "level: {address: 4, type: DINT, scale: {gain: 0.5, offset: -40}, units: mm, description: tank}, "
          "code: {address: 7, type: CHAR, offset: high}, text: {address: 9, type: STRING, length: 5}}")
          .text,
      AllOf(
          HasSubstr("  lamps : ARRAY [0..2] OF BOOL;  (* coils 8 to 10 *)\n"),
          HasSubstr(
              "  level : LREAL;  (* input registers 4 to 5, DINT CDAB, raw * 0.5 - 40.0; mm; tank *)\n"),
          HasSubstr("  code : BYTE;  (* input register 7 high byte, CHAR AB *)\n"),
          HasSubstr(
              "  text : ARRAY [0..5] OF BYTE;  (* input registers 9 to 11, STRING BA, 5 bytes utf-8 *)\n")));
}

TEST(StructuredTextExport, Requests_are_constants_that_a_PLC_can_use) {
  const std::string text = exported(
                               "holding_registers: {a: {address: 3, type: INT}, b: {address: 4, type: REAL}, "
                               "c: {address: 9, type: INT}}",
                               "name: m, address: 10.0.0.7, port: 1502, unit: 3")
                               .text;
  for (const char* line :
       {"m_host : STRING[8] := '10.0.0.7';", "m_port : UINT := 1502;", "m_unit : BYTE := 3;",
        "m_read_holding_registers_3_function : BYTE := 3;", "m_read_holding_registers_3_address : UINT := 3;",
        "m_read_holding_registers_3_quantity : UINT := 3;",
        "m_write_holding_registers_3_function : BYTE := 16;",
        "m_write_holding_registers_9_function : BYTE := 6;", "m_b_address : UINT := 4;",
        "m_b_quantity : UINT := 2;"})
    EXPECT_THAT(text, HasSubstr(line));
}

TEST(StructuredTextExport, What_does_more_than_to_be_set_is_written_by_itself) {
  const std::string text =
      exported(
          "coils: {a: 0, b: {address: 1, latched: {of: i, edge: rising}}, c: 2, "
          "d: {address: 3, write_function: multiple}, "
          "e: {address: 9, write_function: multiple}}, discrete_inputs: {i: {address: 0, line: GPIO4}}")
          .text;
  for (const char* part : {"m_write_coils_0_quantity : UINT := 1;", "m_write_coils_1_function : BYTE := 5;",
                           "m_write_coils_2_quantity : UINT := 2;", "m_write_coils_9_function : BYTE := 15;"})
    EXPECT_THAT(text, HasSubstr(part));
}

TEST(StructuredTextExport, Requests_are_no_longer_than_the_device_takes) {
  const std::string text =
      exported("holding_registers: {a: {address: 0, type: INT, count: 4}, b: {address: 4, type: INT}}",
               "name: m, limits: {read_registers: 4, write_registers: 4}")
          .text;
  EXPECT_THAT(text, AllOf(HasSubstr("m_read_holding_registers_0_quantity : UINT := 4;"),
                          HasSubstr("m_read_holding_registers_4_quantity : UINT := 1;"),
                          HasSubstr("m_write_holding_registers_0_quantity : UINT := 4;"),
                          HasSubstr("m_write_holding_registers_4_quantity : UINT := 1;")));
}

TEST(StructuredTextExport, An_output_is_read_where_it_reads_back) {
  EXPECT_THAT(exported("coils: {a: {address: 3, read_address: 515}}").text,
              AllOf(HasSubstr("m_read_coils_515_address : UINT := 515;"),
                    HasSubstr("m_write_coils_3_address : UINT := 3;"), HasSubstr("a : BOOL;  (* coil 515 *)"),
                    HasSubstr("m_a_read_address : UINT := 515;")));
}

TEST(StructuredTextExport, A_map_without_64_bits_needs_no_type_of_64_bits) {
  EXPECT_THAT(exported("holding_registers: {a: {address: 0, type: REAL}, b: {address: 2, type: UDINT}}").text,
              AllOf(Not(HasSubstr("LREAL")), Not(HasSubstr("LWORD")), Not(HasSubstr("LINT"))));
}

TEST(StructuredTextExport, A_map_without_outputs_has_no_part_for_them) {
  EXPECT_THAT(exported("discrete_inputs: {a: 0}").text,
              AllOf(HasSubstr("m_decode"), Not(HasSubstr("m_encode")), Not(HasSubstr("m_outputs"))));
  EXPECT_THAT(exported("coils: {a: {address: 0, access: write}}").text,
              AllOf(HasSubstr("m_encode"), Not(HasSubstr("m_decode"))));
}

TEST(StructuredTextExport, The_fingerprint_is_as_the_identity_area_has_it) {
  EXPECT_THAT(exported("coils: {a: 0}").text,
              testing::ContainsRegex(
                  "input registers 65283 to 65286 [*][)]\n  m_fingerprint : ARRAY \\[0..3\\] OF WORD "
                  ":= \\[16#[0-9A-F]{4}, 16#[0-9A-F]{4}, 16#[0-9A-F]{4}, 16#[0-9A-F]{4}\\];"));
}

TEST(StructuredTextExport, Names_are_identifiers_in_either_case_and_changes_are_told) {
  const std::string points = "coils: {Lamp: 0, lamp: 1, arm/left: 2, a__b: 3, While: 4, ton: 5}";
  for (const char* name : {" Lamp :", " lamp_2 :", " arm_left :", " a_b :", " While_value :", " ton_value :"})
    EXPECT_THAT(exported(points).text, HasSubstr(name));
  EXPECT_THAT(
      told(points),
      AllOf(HasSubstr("names that would be those of other points get a number: lamp;"),
            HasSubstr("names that are no identifiers of Structured Text are changed: arm/left, a__b;"),
            HasSubstr("names that are words of Structured Text get '_value': While, ton;")));
}

TEST(StructuredTextExport, No_text_ends_its_comment) {
  const std::string text =
      exported(R"(coils: {a: {address: 0, description: "x *) y (*) /* */ *\n\u202E"}})").text;
  EXPECT_THAT(text, HasSubstr(R"((* coil 0; x * ) y ( * ) / * * / *\x0a\u202e *))"));
}

TEST(StructuredTextExport, What_a_PLC_cannot_have_is_told_with_the_points) {
  EXPECT_THAT(
      told("holding_registers: {text: {address: 0, type: STRING, length: 4}, "
           "r: {address: 4, type: REAL, allow_nonfinite: true}}"),
      AllOf(HasSubstr("texts are arrays of bytes, since Structured Text makes no STRING of bytes: text;"),
            HasSubstr("NaN and infinities are reported in place of being read or written: r;")));
}

}  // namespace
}  // namespace coupler::test
