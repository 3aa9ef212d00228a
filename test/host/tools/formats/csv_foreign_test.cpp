// SPDX-License-Identifier: Apache-2.0
// Tables of OPC servers, of makers and of German offices: addresses, types, scales and names as they write
// them.
#include <gmock/gmock.h>

#include <random>

#include "test/host/tools/formats/imported.hpp"

namespace coupler::test {
namespace {

using testing::HasSubstr;
using testing::Not;

formats::ImportOptions modicon() {
  formats::ImportOptions options{"m", {}};
  options.addressing = loader::Addressing::modicon;
  options.order = "CDAB";
  return options;
}

/// The point of a row `a,ADDRESS,TYPE` in Modicon's numbers, or what is said of it.
std::string point_at(const std::string& address, const std::string& type) {
  const Imported csv("csv", "name,address,type\na,\"" + address + "\"," + type + "\n", modicon());
  return csv.result.maps.empty() ? csv.said : csv.text();
}

TEST(CsvForeign, An_address_may_have_a_bit_a_length_a_count_or_its_last_register) {
  EXPECT_THAT(point_at("400020.03", "Boolean"), HasSubstr("a: {address: 400020, type: BOOL, bit: 3}"));
  EXPECT_THAT(point_at("400020.15", ""), HasSubstr("a: {address: 400020, type: BOOL, bit: 15}"));
  EXPECT_THAT(point_at("40020:3", "bit"), HasSubstr("a: {address: 40020, type: BOOL, bit: 3}"));
  EXPECT_THAT(point_at("400030.20H", "String"),
              HasSubstr("a: {address: 400030, type: STRING, length: 20, order: AB}"));
  EXPECT_THAT(point_at("400030.20L", "String"), HasSubstr("a: {address: 400030, type: STRING, length: 20}"));
  EXPECT_THAT(point_at("400060 [8]", "Short Array"), HasSubstr("a: {address: 400060, type: INT, count: 8}"));
  EXPECT_THAT(point_at("400060[8]", "Word"), HasSubstr("a: {address: 400060, type: WORD, count: 8}"));
  EXPECT_THAT(point_at("40001-40002", "DINT"), HasSubstr("a: {address: 40001, type: DINT, order: CDAB}"));
  EXPECT_THAT(point_at("40001..40004", "LREAL"), HasSubstr("a: {address: 40001, type: LREAL"));
  EXPECT_THAT(point_at("40001-40003", "STRING"), HasSubstr("a: {address: 40001, type: STRING, length: 6}"));
}

TEST(CsvForeign, A_column_Bits_is_the_width_of_the_type_or_says_which_bits) {
  const Imported csv("csv",
                     "table,name,address,type,Bits\nholding,a,1,UINT,16\nholding,b,2,UINT,8-11\n"
                     "holding,c,3,INT,16\nholding,d,4,WORD,0 .. 3\n");
  ASSERT_FALSE(csv.result.maps.empty()) << csv.said;
  EXPECT_THAT(csv.text(), HasSubstr("a: {address: 1, type: UINT}"));
  EXPECT_THAT(csv.text(), HasSubstr("b: {address: 2, type: UINT, bits: [8, 11]}"));
  EXPECT_THAT(csv.text(), HasSubstr("c: {address: 3, type: INT}"));
  EXPECT_THAT(csv.text(), HasSubstr("d: {address: 4, type: WORD, bits: [0, 3]}"));
}

TEST(CsvForeign, An_address_may_name_its_table) {
  EXPECT_THAT(point_at("4x00020", "INT"),
              HasSubstr("holding_registers:\n    a: {address: 400020, type: INT}"));
  EXPECT_THAT(point_at("3x7", "INT"), HasSubstr("input_registers:\n    a: {address: 300007, type: INT}"));
  EXPECT_THAT(point_at("1x00003", "BOOL"), HasSubstr("discrete_inputs:\n    a: 100003"));
  EXPECT_THAT(point_at("HR20", "INT"), HasSubstr("holding_registers:\n    a: {address: 20, type: INT}"));
  EXPECT_THAT(point_at("IR 20", "INT"), HasSubstr("input_registers:\n    a: {address: 20, type: INT}"));
  EXPECT_THAT(point_at("Coil 5", ""), HasSubstr("coils:\n    a: 5"));
  // Where addresses count from 0, too, and no column `table` is needed then.
  EXPECT_THAT(Imported("csv", "name,address,type\na,HR[20],INT\nb,DI 3,BOOL\n").text(),
              HasSubstr("discrete_inputs:\n    b: 3\n  holding_registers:\n    a: {address: 20, type: INT}"));
  EXPECT_THAT(Imported("csv", "name,table,address,type\na,hr,4x0020,INT\n").said,
              HasSubstr("given:2:6: error: '4x0020' is a Modicon number, which counts from 1; read the file "
                        "with --addressing modicon"));
  EXPECT_THAT(Imported("csv", "name,table,address,type\na,hr,0x20,INT\n").text(), HasSubstr("address: 0x20"));
  EXPECT_THAT(
      Imported("csv", "name,table,address,type\na,ir,HR20,INT\n").said,
      HasSubstr("given:2:6: error: 'HR20' is in holding_registers, but the row says input_registers"));
}

TEST(CsvForeign, A_table_may_be_said_twice_or_by_its_function_code) {
  const auto made = [](const std::string& table, const std::string& address) {
    const Imported csv("csv", "name,table,address,type\na," + table + "," + address + ",INT\n");
    return csv.result.maps.empty() ? csv.said : csv.text();
  };
  for (const char* table : {"Input Register (3x)", "3xxxx", "3xxxxx", "Input (FC04)", "input registers [3x]"})
    EXPECT_THAT(made(table, "1"), HasSubstr("input_registers:\n    a: {address: 1,")) << table;
  EXPECT_THAT(made("Holding (FC03)", "1"), HasSubstr("holding_registers:"));
  EXPECT_THAT(made("Holding (FC04)", "1"),
              HasSubstr("'Holding (FC04)' is holding_registers and input_registers"));
  const auto at = [](const std::string& address) {
    return Imported("csv", "name,address,type\na," + address + ",INT\n").text();
  };
  EXPECT_THAT(at("input 20"), HasSubstr("input_registers:\n    a: {address: 20,"));
  EXPECT_THAT(at("FC3 30"), HasSubstr("holding_registers:\n    a: {address: 30,"));
  EXPECT_THAT(at("FC04:31"), HasSubstr("input_registers:\n    a: {address: 31,"));
}

TEST(CsvForeign, An_address_that_is_none_is_told_at_its_cell) {
  const auto told = [](const std::string& what) { return HasSubstr("given:2:3: error: " + what); };
  EXPECT_THAT(point_at("400020.03", "INT"),
              told("'400020.03' is not a Modicon number; a bit is type: BOOL, bit: 3 at 400020"));
  EXPECT_THAT(point_at("400020.16", "BOOL"), told("'400020.16' has no bit"));
  EXPECT_THAT(point_at("000005.3", "BOOL"),
              told("'000005.3' is a bit of a register, but the point is in coils"));
  EXPECT_THAT(point_at("400030.20H", "INT"), told("'400030.20H' is a text of 20 bytes"));
  EXPECT_THAT(point_at("400030.20", "String"), told("'400030.20' does not say which byte"));
  EXPECT_THAT(point_at("400060 [2][3]", "INT"), told("'400060 [2][3]' is not a Modicon number"));
  EXPECT_THAT(point_at("40001-40003", "DINT"), told("'40001-40003' says 3 registers, but the point has 2"));
  EXPECT_THAT(point_at("5", "INT"), told("the address '5' does not say its table"));
  EXPECT_THAT(point_at("50001", "INT"), told("'50001' is not a Modicon number"));
  EXPECT_THAT(point_at("4x", "INT"), told("'4x' is not a Modicon number"));
  EXPECT_THAT(point_at("4x123456", "INT"), told("'4x123456' is not a Modicon number"));
  for (const char* variable : {"%MW20", "%IW3", "%QX0.1"})
    EXPECT_THAT(point_at(variable, "INT"),
                told("'" + std::string(variable) + "' is a variable in a PLC's program"));
  EXPECT_THAT(point_at("", "INT"), told("the point has no address"));
  EXPECT_THAT(Imported("csv", "table,name,type,address\nhr,a,INT\n").said,
              HasSubstr("given:2:6: error: the point has no address"));
}

TEST(CsvForeign, An_empty_cell_is_told_at_its_place) {
  EXPECT_EQ(
      Imported("csv", "table,name,address,type\nhr,a,1,\n,b,2,INT\nhr,c,,INT\n").said,
      "given:2:8: error: the point has no type; write what its registers hold, as in INT\n"
      "given:3:1: error: the address '2' does not say its table; write the table into this cell\n"
      "given:4:6: error: the point has no address; write it in the column of addresses, or remove the row\n");
}

constexpr const char* kepware =
    "Tag Name,Address,Data Type,Client Access,Scaling,Raw Low,Raw High,Scaled Low,"
    "Scaled High,Eng Units,Negate Value\n";

TEST(CsvForeign, Kepwares_linear_scaling_is_two_points_of_the_line) {
  const Imported csv("csv",
                     std::string(kepware) +
                         "a,400001,Short,RO,Linear,0,1000,-20,100,C,0\n"
                         "b,400002,Short,R/W,Linear,0,1000,-20,100,,1\n"
                         "c,400003,Short,RO,None,0,1000,0,100,,0\n"
                         "d,400004,Short,RO,,,,,,,\n",
                     modicon());
  EXPECT_EQ(csv.said, "");
  for (const char* line :
       {"a: {address: 400001, type: INT, access: read, units: C, scale: {raw: [0, 1000], value: [-20, 100]}}",
        "b: {address: 400002, type: INT, access: read_write, scale: {raw: [0, 1000], value: [20, -100]}}",
        "c: {address: 400003, type: INT, access: read}", "d: {address: 400004, type: INT, access: read}"})
    EXPECT_THAT(csv.text(), HasSubstr(line));
}

TEST(CsvForeign, A_scaling_that_no_map_has_is_told_at_its_cell) {
  const std::string said = Imported("csv",
                                    std::string(kepware) +
                                        "a,400001,Short,RO,Square Root,0,1000,0,100,,0\n"
                                        "b,400002,Short,RO,Linear,0,,0,100,,0\n"
                                        "c,400003,Short,RO,Linear,0,1000,0,x,,0\n"
                                        "d,400004,Short,RO,Cubic,0,1000,0,1,,0\n"
                                        "e,400005,Short,RO,None,,,,,,1\n",
                                    modicon())
                               .said;
  for (const char* told :
       {"given:2:19: error: 'Square Root' is no straight line",
        "given:3:28: error: a linear scaling has no 'raw_high'", "given:4:35: error: 'x' is not a number",
        "given:5:19: error: 'Cubic' is not a scaling; write Linear or None",
        "given:6:29: warning: the value is not negated"})
    EXPECT_THAT(said, HasSubstr(told));
}

TEST(CsvForeign, A_range_is_min_and_max) {
  const auto range = [](const std::string& cell, const std::string& type = "INT") {
    const Imported csv("csv", "table,name,address,type,bit,Range\nhr,a,1," + type + ",,\"" + cell + "\"\n");
    return csv.result.maps.empty() ? csv.said : csv.text();
  };
  for (const char* cell : {"0..100", "0 to 100", "0-100", "0 - 100", "0 … 100", "[0; 100]", "0 V to 100 V",
                           "0–100 %", "0x0..0x64", "0~100"})
    EXPECT_THAT(range(cell), HasSubstr("min: 0, max: 100}")) << cell;
  EXPECT_THAT(range("-40..-10"), HasSubstr("min: -40, max: -10}"));
  EXPECT_THAT(Imported("csv", "table,name,address,type,Max,Range\nhr,a,1,INT,4,0..5\n").said,
              HasSubstr("given:2:14: error: the range '0..5' contradicts 'max: 4'"));
  EXPECT_THAT(range("0..7", "WORD"), HasSubstr("a: {address: 1, type: WORD}"));
  EXPECT_THAT(range("0..70000"), HasSubstr("given:2:13: error: 'max' is 70000"));
}

TEST(CsvForeign, Names_are_spelt_in_ASCII) {
  const auto name = [](const std::string& given) {
    return Imported("csv", "table,name,address\ncoils," + given + ",3\n").text();
  };
  EXPECT_THAT(name("Ölstand"), HasSubstr("oelstand: {address: 3, description: \"Ölstand\"}"));
  EXPECT_THAT(name("Kühler 1"), HasSubstr("kuehler_1: {"));
  EXPECT_THAT(name("Faßdruck"), HasSubstr("fassdruck: {"));
  EXPECT_THAT(name("débit"), HasSubstr("debit: {"));
  EXPECT_THAT(name("Łódź"), HasSubstr("lodz: {"));
  EXPECT_THAT(name("O\xCC\x88lstand"), HasSubstr("oelstand: {"));  // as macOS writes it
  EXPECT_THAT(name("Temp °C"), HasSubstr("Temp_C: {"));
  EXPECT_THAT(name("温度"), HasSubstr("given:2:7: error: the name '温度' has '温', which has no spelling"));
}

TEST(CsvForeign, Names_that_are_one_in_ASCII_are_told_with_both_lines) {
  for (const char* other : {"Oelstand", "oelstand", "ÖLSTAND"}) {
    const Imported csv("csv", "table,name,address\ncoils,Ölstand,3\ncoils," + std::string(other) + ",4\n");
    EXPECT_THAT(csv.said, HasSubstr("given:3:7: error: '" + std::string(other) +
                                    "' and 'Ölstand' in line 2 would both be called 'oelstand'"));
    EXPECT_THAT(csv.said, Not(HasSubstr("oelstand_2")));
  }
}

TEST(CsvForeign, A_broken_table_is_a_map_or_an_error_whatever_is_broken) {
  const std::string good =
      "Tag,Address,Type,Scaling,Raw Low,Raw High,Scaled Low,Scaled High,Unit,Range,Quantity,Offset\n"
      "Öl,400020.03,BOOL,,,,,,,,,\n"
      "b,400030.20H,String[20],,,,,,0.1V,0..1,10,\n"
      "c,400060 [8],Short Array,Linear,0,1000,-1,1,%*10,-4 to 5 V,8,high\n"
      "d,4x00100-4x00101,Float CDAB,None,,,,,1/10 A,[0;1],2,0\n";
  std::mt19937 random(1);  // NOLINT: the same every time
  constexpr std::string_view bytes = "{}[]().:-*/x%'\",;\n\t 0149HLAe^\xC3\x96";
  for (int round = 0; round < 20000; ++round) {
    std::string text = good;
    for (int change = 0; change < 4; ++change) text[random() % text.size()] = bytes[random() % bytes.size()];
    if (round % 3 == 0) text.resize(random() % text.size());
    const Imported imported("csv", text, modicon());
    ASSERT_EQ(imported.result.maps.empty(), has_errors(imported.result.diagnostics)) << text << imported.said;
  }
}

TEST(CsvForeign, A_line_of_a_million_headings_is_refused_at_once) {
  EXPECT_THAT(Imported("csv", "table,name,address" + std::string(1'000'000, ',') + "\ncoils,a,0\n").said,
              HasSubstr("given:1:1: error: the first line has 1000003 headings"));
}

}  // namespace
}  // namespace coupler::test
