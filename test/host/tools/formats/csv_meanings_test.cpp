// SPDX-License-Identifier: Apache-2.0
// Columns and cells with two meanings: both are named, with the option that chooses.
#include <gmock/gmock.h>

#include "test/host/tools/formats/imported.hpp"

namespace coupler::test {
namespace {

using testing::HasSubstr;
using testing::Not;

/// What becomes of the table if the caller chooses.
std::string chosen(const std::string& table, const std::string& column, const std::string& heading) {
  formats::ImportOptions options{"m", {}};
  options.columns = {{column, heading}};
  const Imported csv("csv", table, options);
  return csv.result.maps.empty() ? csv.said : csv.text();
}

TEST(CsvMeanings, Units_with_a_factor_are_asked_for) {
  const auto table = [](const std::string& units) {
    return "table,name,address,type,Unit\nir,a,1,INT,V\nir,b,2,INT,\"" + units + "\"\n";
  };
  for (const char* units :
       {"0.1V", "0.01 Hz", "0.1°C", "0,1 bar", "100 W", "10^-1 A", "1e-2 A", "1/10 A", "V/10"}) {
    const std::string said = Imported("csv", table(units)).said;
    EXPECT_THAT(said,
                HasSubstr("given:3:12: error: the units '" + std::string(units) + "' have two meanings"));
    EXPECT_THAT(said,
                HasSubstr("write --columns 'scaled_units=Unit' for the first, or --columns 'units=Unit'"));
    EXPECT_THAT(said, Not(HasSubstr("warning")));
  }
  for (const char* units : {"x10", "%*10", "kWh (x 100)", "× 0.1", "x10 W"})
    EXPECT_THAT(Imported("csv", table(units)).said,
                HasSubstr("--columns 'divided_units=Unit' for the second"))
        << units;
  for (const char* units : {"1/min", "m³/h", "kg*m", "l/100km", "%", "V AC", "imp/kWh"})
    EXPECT_EQ(Imported("csv", table(units)).said, "") << units;
  EXPECT_THAT(chosen(table("0.1 V"), "scaled_units", "Unit"),
              HasSubstr("b: {address: 2, type: INT, units: V, scale: 0.1}"));
  EXPECT_THAT(chosen(table("%*10"), "scaled_units", "Unit"), HasSubstr("units: \"%\", scale: 10}"));
  EXPECT_THAT(chosen(table("%*10"), "divided_units", "Unit"), HasSubstr("units: \"%\", scale: 0.1}"));
  EXPECT_THAT(chosen(table("0.1 V"), "units", "Unit"),
              HasSubstr("b: {address: 2, type: INT, units: \"0.1 V\"}"));
}

TEST(CsvMeanings, Units_with_the_factor_of_the_scale_are_the_units_alone) {
  const std::string head = "table,name,address,type,Unit,";
  EXPECT_THAT(Imported("csv", head + "Factor\nir,a,1,INT,0.1V,0.1\n").text(),
              HasSubstr("a: {address: 1, type: INT, units: V, scale: 0.1}"));
  EXPECT_THAT(Imported("csv", head + "Divisor\nir,a,1,INT,V*10,10\n").text(),
              HasSubstr("units: V, scale: 0.1}"));
  EXPECT_THAT(Imported("csv", head + "Factor\nir,a,1,INT,0.1V,1\n").said, HasSubstr("have two meanings"));
  EXPECT_THAT(Imported("csv", head + "Factor\ncoils,a,1,,0.1V,\n").said, Not(HasSubstr("two meanings")));
}

TEST(CsvMeanings, The_order_of_several_registers_is_asked_for_once) {
  const std::string table = "table,name,address,type\nir,a,1,INT\nir,b,2,U32\nir,c,4,double\nir,d,8,Float\n";
  EXPECT_EQ(
      Imported("csv", table).said,
      "given:3:8: error: 'U32' has several registers, and the table does not say which comes first: the "
      "most significant one (ABCD), or the least (CDAB) (2 more ask the same); say it for all of them with "
      "--order ABCD or --order CDAB, or in a column 'order'\n");
  formats::ImportOptions options{"m", {}};
  options.order = "ABCD";
  const Imported csv("csv", table, options);
  EXPECT_EQ(csv.said, "");
  for (const char* line : {"a: {address: 1, type: INT}", "b: {address: 2, type: UDINT, order: ABCD}",
                           "c: {address: 4, type: LREAL, order: ABCD}"})
    EXPECT_THAT(csv.text(), HasSubstr(line));
}

TEST(CsvMeanings, The_order_may_stand_in_a_column_or_behind_the_type) {
  const Imported csv("csv",
                     "table,name,address,type,Byte order\nir,a,1,U32,ABCD\nir,b,3,Float CDAB,\n"
                     "ir,c,5,uint32_badc,\nir,d,7,DINT (DCBA),\n");
  EXPECT_EQ(csv.said, "");
  for (const char* line :
       {"a: {address: 1, type: UDINT, order: ABCD}", "b: {address: 3, type: REAL, order: CDAB}",
        "c: {address: 5, type: UDINT, order: BADC}", "d: {address: 7, type: DINT, order: DCBA}"})
    EXPECT_THAT(csv.text(), HasSubstr(line));
}

TEST(CsvMeanings, Two_orders_of_one_point_are_told) {
  EXPECT_THAT(Imported("csv", "table,name,address,type,order\nir,a,1,Float CDAB,ABCD\n").said,
              HasSubstr("given:2:8: error: 'Float CDAB' and the order 'ABCD' contradict each other"));
}

TEST(CsvMeanings, A_number_behind_STRING_counts_characters_or_registers) {
  for (const char* type : {"string[6]", "STRING(6)", "String 6", "char[6]", "str6", "ASCII[6]"}) {
    const std::string table = std::string("table,name,address,type\nhr,a,1,") + type + "\n";
    EXPECT_THAT(
        Imported("csv", table).said,
        HasSubstr("given:2:8: error: '" + std::string(type) +
                  "' has two meanings: 6 characters, or 6 registers, which hold 12; say it for all such "
                  "types with --strings characters or --strings registers"));
    EXPECT_THAT(Imported("csv", table).said, Not(HasSubstr("has no 'length'")));
    formats::ImportOptions options{"m", {}};
    options.strings = "characters";
    EXPECT_THAT(Imported("csv", table, options).text(),
                HasSubstr("a: {address: 1, type: STRING, length: 6}"));
    options.strings = "registers";
    EXPECT_THAT(Imported("csv", table, options).text(),
                HasSubstr("a: {address: 1, type: STRING, length: 12}"));
  }
  EXPECT_THAT(Imported("csv", "table,name,address,type,Quantity\nhr,a,1,string[6],3\n").text(),
              HasSubstr("length: 6}"));
  EXPECT_THAT(Imported("csv", "table,name,address,type,Quantity\nhr,a,1,string[6],6\n").text(),
              HasSubstr("length: 12}"));
  EXPECT_THAT(Imported("csv", "table,name,address,type,length\nhr,a,1,string[6],12\n").text(),
              HasSubstr("length: 12}"));
  EXPECT_THAT(Imported("csv", "table,name,address,type\nhr,a,1,string[99999999999999999999]\n").said,
              HasSubstr("given:2:8: error:"));
}

TEST(CsvMeanings, An_offset_is_added_to_the_value_or_to_the_address) {
  const std::string table =
      "table,name,address,type,Faktor,Offset\nhr,a,100,INT,\"0,1\",-40\nhr,b,101,INT,,\n";
  EXPECT_THAT(
      Imported("csv", table).said,
      HasSubstr("given:1:32: error: 'Offset' has several meanings: '-40' may be added to the scaled value, "
                "behind the factor; to the register, before the factor; or to the address; write --columns "
                "'scale_offset=Offset', --columns 'raw_offset=Offset' or --columns 'address_offset=Offset'"));
  EXPECT_THAT(
      chosen(table, "scale_offset", "Offset"),
      HasSubstr("a: {address: 100, type: INT, scale: {gain: 0.1, offset: -40}}\n    b: {address: 101, "
                "type: INT}"));
  EXPECT_THAT(chosen(table, "address_offset", "Offset"),
              HasSubstr("given:2:20: error: '-40' cannot be added"));
  EXPECT_THAT(chosen("table,name,address,type,Offset\nhr,a,100,INT,5\n", "address_offset", "Offset"),
              HasSubstr("a: {address: 105, type: INT}"));
  EXPECT_EQ(Imported("csv", "table,name,address,type,Offset\nhr,a,100,INT,0\nhr,b,101,INT,\n").said, "");
  EXPECT_THAT(Imported("csv", "table,name,address,type,Offset\nhr,a,100,SINT,low\n").text(),
              HasSubstr("offset: low"));
}

TEST(CsvMeanings, Ranges_may_say_what_a_gain_is) {
  const auto table = [](const std::string& row) {
    return "table,name,address,type,Range,Gain\nir,a,1,U16," + row + "\n";
  };
  const Imported divisor("csv", table("0 to 6553.5,10"));
  EXPECT_THAT(divisor.text(), HasSubstr("scale: 0.1, min: 0, max: 6553.5}"));
  EXPECT_THAT(
      divisor.said,
      HasSubstr("given:1:31: warning: 'Gain' is read as a divisor, for the ranges and units in the table "
                "fit only that; if that is wrong, write --columns 'scale=Gain'"));
  EXPECT_THAT(Imported("csv", table("0 to 6553.5,0.1")).text(),
              HasSubstr("scale: 0.1, min: 0, max: 6553.5}"));
  for (const char* row : {"0 to 100,10", ",10", "0 to 0.55,10"})
    EXPECT_THAT(Imported("csv", table(row)).said, HasSubstr("'Gain' has two meanings")) << row;
}

TEST(CsvMeanings, Input_and_output_are_two_tables_until_the_type_says_which) {
  const auto said = [](const std::string& table, const std::string& type) {
    const Imported csv("csv", "name,table,address,type\na," + table + ",1," + type + "\n");
    return csv.result.maps.empty() ? csv.said : csv.text();
  };
  EXPECT_THAT(said("input", "INT"), HasSubstr("input_registers:"));
  EXPECT_THAT(said("Outputs", "UINT"), HasSubstr("holding_registers:"));
  EXPECT_THAT(said("input", "BOOL"),
              HasSubstr("given:2:3: error: 'input' is discrete_inputs or input_registers"));
  EXPECT_THAT(said("output", ""), HasSubstr("given:2:3: error: 'output' is coils or holding_registers"));
}

TEST(CsvMeanings, What_may_be_written_is_known_in_many_words) {
  const auto access = [](const std::string& heading, const std::string& cell) {
    return Imported("csv", "table,name,address,type," + heading + "\nhr,a,1,INT," + cell + "\n").text();
  };
  for (const char* heading : {"Client Access", "R/W", "Access", "Lesen/Schreiben", "Zugriff"}) {
    for (const char* cell : {"R/W", "RW", "Read/Write", "Read/Write (RW)", "Lecture/Écriture",
                             "Lesen/Schreiben", "W/R", "R + W", "read & write"})
      EXPECT_THAT(access(heading, cell), HasSubstr("access: read_write}")) << heading << ' ' << cell;
    for (const char* cell : {"RO", "R", "read-only", "Read Only", "nur lesen", "Lecture"})
      EXPECT_THAT(access(heading, cell), HasSubstr("access: read}")) << heading << ' ' << cell;
    for (const char* cell : {"WO", "W", "write-only"})
      EXPECT_THAT(access(heading, cell), HasSubstr("access: write}")) << heading << ' ' << cell;
  }
  EXPECT_THAT(access("schreibbar", "ja"), HasSubstr("access: read_write}"));
  EXPECT_THAT(access("schreibbar", "nein"), HasSubstr("access: read}"));
}

TEST(CsvMeanings, The_number_of_registers_must_be_that_of_the_type) {
  const std::string head = "table,name,address,type,order,Quantity\n";
  EXPECT_EQ(Imported("csv", head + "hr,a,1,I32,ABCD,2\nhr,b,3,U16,,1\ncoils,c,1,,,1\n").said, "");
  EXPECT_THAT(Imported("csv", head + "hr,a,1,I32,ABCD,1\n").said,
              HasSubstr("given:2:17: error: '1' says 1 register, but the point has 2"));
  EXPECT_THAT(Imported("csv", head + "hr,a,1,U16,,two\n").said,
              HasSubstr("'two' is not a number of registers"));
}

}  // namespace
}  // namespace coupler::test
