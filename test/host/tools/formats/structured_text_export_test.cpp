// SPDX-License-Identifier: Apache-2.0
// How the file looks, and what is told. That it means the right thing is proved by test/plc, on another's
// parser.
#include <gmock/gmock.h>

#include "coupler/map/loader/load.hpp"
#include "coupler/tools/formats/exporters.hpp"
#include "test/host/tools/formats/imported.hpp"

namespace coupler::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

formats::Export structured_text(const std::string& points, const std::string& top = "name: m") {
  const LoadResult loaded = load_map("{" + top + ", mapping: {" + points + "}}", "m");
  EXPECT_NE(loaded.map, nullptr) << lines_of(loaded.diagnostics);
  return loaded.map ? formats::write_structured_text(loaded.map->map()) : formats::Export{};
}

std::string told(const std::string& points) {
  return lines_of(structured_text(points).warnings.diagnostics("m"));
}

TEST(StructuredTextExport, A_value_is_declared_with_its_type_where_it_is_and_what_it_means) {
  EXPECT_THAT(
      structured_text(
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
  const std::string text = structured_text(
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

TEST(StructuredTextExport, A_serial_line_has_no_host_and_no_port) {
  const auto out = structured_text(
      "coils: {a: 0}", "name: m, unit: 3, serial: {device: /dev/ttyS0, baud: 9600, parity: none}");
  EXPECT_THAT(out.text,
              AllOf(HasSubstr("m_unit : BYTE := 3;"), Not(HasSubstr("m_host")), Not(HasSubstr("m_port"))));
  EXPECT_THAT(lines_of(out.warnings.diagnostics("m")),
              HasSubstr("use the PLC's client for Modbus RTU, at 9600 8N1"));
  EXPECT_THAT(lines_of(structured_text("coils: {a: 0}", "name: m, framing: rtu, address: gateway, port: 4001")
                           .warnings.diagnostics("m")),
              HasSubstr("the coupler speaks RTU over TCP"));
}

TEST(StructuredTextExport, What_does_more_than_to_be_set_is_written_by_itself) {
  const std::string text =
      structured_text(
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
      structured_text("holding_registers: {a: {address: 0, type: INT, count: 4}, b: {address: 4, type: INT}}",
                      "name: m, limits: {read_registers: 4, write_registers: 4}")
          .text;
  EXPECT_THAT(text, AllOf(HasSubstr("m_read_holding_registers_0_quantity : UINT := 4;"),
                          HasSubstr("m_read_holding_registers_4_quantity : UINT := 1;"),
                          HasSubstr("m_write_holding_registers_0_quantity : UINT := 4;"),
                          HasSubstr("m_write_holding_registers_4_quantity : UINT := 1;")));
}

TEST(StructuredTextExport, An_output_is_read_where_it_reads_back) {
  EXPECT_THAT(structured_text("coils: {a: {address: 3, read_address: 515}}").text,
              AllOf(HasSubstr("m_read_coils_515_address : UINT := 515;"),
                    HasSubstr("m_write_coils_3_address : UINT := 3;"), HasSubstr("a : BOOL;  (* coil 515 *)"),
                    HasSubstr("m_a_read_address : UINT := 515;")));
}

TEST(StructuredTextExport, A_map_without_64_bits_needs_no_type_of_64_bits) {
  EXPECT_THAT(
      structured_text("holding_registers: {a: {address: 0, type: REAL}, b: {address: 2, type: UDINT}}").text,
      AllOf(Not(HasSubstr("LREAL")), Not(HasSubstr("LWORD")), Not(HasSubstr("LINT"))));
}

TEST(StructuredTextExport, A_map_without_outputs_has_no_part_for_them) {
  EXPECT_THAT(structured_text("discrete_inputs: {a: 0}").text,
              AllOf(HasSubstr("m_decode"), Not(HasSubstr("m_encode")), Not(HasSubstr("m_outputs"))));
  EXPECT_THAT(structured_text("coils: {a: {address: 0, access: write}}").text,
              AllOf(HasSubstr("m_encode"), Not(HasSubstr("m_decode"))));
}

TEST(StructuredTextExport, The_fingerprint_is_as_the_identity_area_has_it) {
  EXPECT_THAT(structured_text("coils: {a: 0}").text,
              testing::ContainsRegex(
                  "input registers 65283 to 65286 [*][)]\n  m_fingerprint : ARRAY \\[0..3\\] OF WORD "
                  ":= \\[16#[0-9A-F]{4}, 16#[0-9A-F]{4}, 16#[0-9A-F]{4}, 16#[0-9A-F]{4}\\];"));
}

TEST(StructuredTextExport, Names_are_identifiers_in_either_case_and_changes_are_told) {
  const std::string points = "coils: {Lamp: 0, lamp: 1, arm/left: 2, a__b: 3, While: 4, ton: 5}";
  for (const char* name : {" Lamp :", " lamp_2 :", " arm_left :", " a_b :", " While_value :", " ton_value :"})
    EXPECT_THAT(structured_text(points).text, HasSubstr(name));
  EXPECT_THAT(
      told(points),
      AllOf(HasSubstr("names that would be those of other points get a number: lamp;"),
            HasSubstr("names that are no identifiers of Structured Text are changed: arm/left, a__b;"),
            HasSubstr("names that are words of Structured Text get '_value': While, ton;")));
}

TEST(StructuredTextExport, No_text_ends_its_comment) {
  const std::string text =
      structured_text(R"(coils: {a: {address: 0, description: "x *) y (*) /* */ *\n\u202E"}})").text;
  EXPECT_THAT(text, HasSubstr(R"((* coil 0; x * ) y ( * ) / * * / *\x0a\u202e *))"));
}

TEST(StructuredTextExport, Outputs_that_begin_with_another_value_than_0_are_told_unless_the_map_says_which) {
  EXPECT_THAT(
      told("holding_registers: {a: {address: 0, type: INT, min: 5}, b: {address: 1, type: INT, min: 5, "
           "initial: 7}, c: {address: 2, type: INT, values: {1: on_, 2: off_}}, "
           "d: {address: 3, type: INT, min: -1}, e: {address: 4, type: SINT, offset: low, scale: {offset: "
           "500}}, "
           "f: {address: 5, type: INT, min: 5, access: read}}"),
      HasSubstr("outputs begin with the allowed value nearest to 0, since 0 is not allowed: a, c, e; give "
                "'initial' if they are to begin with another value"));
  EXPECT_THAT(told("holding_registers: {a: {address: 0, type: INT, scale: 0.1, max: 5}}"),
              Not(HasSubstr("outputs begin")));
}

TEST(StructuredTextExport, The_write_image_begins_with_the_registers_of_the_outputs) {
  const std::string text =
      structured_text(
          "coils: {a: {address: 7, initial: on}, b: 8}, holding_registers: {c: {address: 0, "
          "type: INT, min: 5}, d: {address: 1, type: INT}, e: {address: 9, type: INT}}")
          .text;
  for (const char* line :
       {"    coils_7 : ARRAY [0..0] OF BYTE := [16#01];", "    coils_7 : ARRAY [0..0] OF BYTE;",
        "    holding_registers_0 : ARRAY [0..1] OF WORD := [16#0005, 16#0000];",
        "    holding_registers_9 : ARRAY [0..0] OF WORD;"})
    EXPECT_THAT(text, HasSubstr(line));
}

TEST(StructuredTextExport, Bits_that_are_only_read_are_copied_where_their_register_is_written_and_told) {
  const std::string points =
      "holding_registers: {ready: {address: 3, type: BOOL, bit: 3, access: read}, run: {address: 3, type: "
      "BOOL, "
      "bit: 4}, alone: {address: 4, type: BOOL, bit: 0, access: read}}";
  EXPECT_THAT(structured_text(points).text,
              AllOf(HasSubstr("  read_image : m_read_image_type;\nEND_VAR\n"),
                    HasSubstr("  image.holding_registers_3[0] := (image.holding_registers_3[0] AND NOT "
                              "WORD#16#0008) OR (read_image.holding_registers_3[0] AND WORD#16#0008);\n")));
  EXPECT_THAT(
      told(points),
      HasSubstr("read-only bits and bytes of registers that are written are copied from the read image: "
                "ready; hand it to m_encode as 'read_image', and read before the first write"));
  EXPECT_THAT(structured_text("holding_registers: {a: {address: 3, type: BOOL, bit: 3, access: write}, "
                              "b: {address: 3, type: BOOL, bit: 4}}")
                  .text,
              Not(HasSubstr("  read_image :")));
}

TEST(StructuredTextExport, Bits_that_no_request_can_read_are_told_to_be_written_as_0) {
  const std::string points =
      "holding_registers: {ready: {address: 3, type: BOOL, bit: 3, access: read, read_address: 20}, "
      "run: {address: 3, type: BOOL, bit: 4, access: write}}";
  EXPECT_THAT(structured_text(points).text, Not(HasSubstr("  read_image :")));
  EXPECT_THAT(
      told(points),
      HasSubstr("read-only bits and bytes that no request can read are written as 0 with their register: "
                "ready; put them into the write image, which keeps them, before the first write"));
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
