// SPDX-License-Identifier: Apache-2.0
// Units that hold a factor: what is asked for, what an answer means, and what contradicts.
#include <gmock/gmock.h>

#include "test/host/tools/formats/imported.hpp"

namespace coupler::test {
namespace {

using testing::HasSubstr;
using testing::Not;

/// The map, or what is said, of a table whose units the caller has explained: "" leaves them open.
std::string with_units(const std::string& rows, const std::string& column, const std::string& more = "") {
  formats::ImportOptions options{"m", {}};
  if (!column.empty()) options.columns = {{column, "Unit"}};
  const Imported csv("csv", "table,name,address,type,Unit" + more + "\n" + rows, options);
  return csv.result.maps.empty() ? csv.said : csv.text();
}

TEST(CsvUnits, An_answer_to_units_of_two_directions_leaves_those_of_one_alone) {
  const std::string rows = "ir,a,1,UINT,0.1V\nir,b,2,UINT,A x10\nir,c,3,UINT,Hz/100\nir,d,4,UINT,%*10\n";
  const std::string divided = with_units(rows, "divided_units");
  for (const char* line : {"a: {address: 1, type: UINT, units: V, scale: 0.1}",
                           "b: {address: 2, type: UINT, units: A, scale: 0.1}",
                           "c: {address: 3, type: UINT, units: Hz, scale: 0.01}"})
    EXPECT_THAT(divided, HasSubstr(line));
  EXPECT_THAT(with_units(rows, "scaled_units"), HasSubstr("units: A, scale: 10}"));
  // One question, and its answers hold for all units.
  EXPECT_THAT(with_units(rows, ""),
              HasSubstr("given:3:13: error: the units 'A x10' have two meanings: a "
                        "register is multiplied by 10, or divided (1 more asks the same)"));
  EXPECT_THAT(with_units(rows, ""), Not(HasSubstr("'0.1V'")));
}

TEST(CsvUnits, A_question_is_asked_once) {
  std::string rows;
  for (int i = 0; i < 60; ++i) rows += "ir,p" + std::to_string(i) + "," + std::to_string(i) + ",UINT,0.1V\n";
  const std::string said = with_units(rows, "");
  EXPECT_THAT(said, HasSubstr("(59 more ask the same)"));
  EXPECT_THAT(said, Not(HasSubstr("given:3")));
}

TEST(CsvUnits, A_factor_is_found_wherever_it_stands) {
  struct Case {
    const char* cell;
    const char* units;
    const char* scale;
  };
  for (const auto& [cell, units, scale] :
       {Case{"0.1 m3/h", "units: m3/h", "0.1"}, Case{"0.1 m^3/h", "units: \"m^3/h\"", "0.1"},
        Case{"0.01 m/s2", "units: m/s2", "0.01"}, Case{"(0.1 °C)", "units: \"°C\"", "0.1"},
        Case{"[0.1 V]", "units: V", "0.1"}, Case{"V (0.1)", "units: V", "0.1"},
        Case{".1V", "units: V", "0.1"}, Case{"V:10", "units: V", "0.1"}, Case{"V÷10", "units: V", "0.1"},
        Case{"V 10^-1", "units: V", "1e-1"}, Case{"1:10 V", "units: V", "0.1"},
        Case{"0.1 l / min", "units: \"l / min\"", "0.1"}, Case{"0.1V/LSB", "units: V", "0.1"},
        Case{"0.1 V DC", "units: \"V DC\"", "0.1"}}) {
    const std::string row = std::string("ir,a,1,INT,\"") + cell + "\"\n";
    EXPECT_THAT(with_units(row, "scaled_units"), HasSubstr(std::string(units) + ", scale: " + scale + "}"))
        << cell;
    EXPECT_THAT(with_units(row, ""), HasSubstr("have two meanings")) << cell;
  }
  EXPECT_THAT(with_units("ir,a,1,INT,0.1\n", "scaled_units"),
              HasSubstr("a: {address: 1, type: INT, scale: 0.1}"));
  EXPECT_THAT(with_units("ir,a,1,INT,0.1\n", ""), HasSubstr("have two meanings"));
  for (const char* cell :
       {"m3/h", "m^3", "s^-1", "m·s-2", "1/min", "l/100km", "PM2.5", "CO2", "h:min", "V/m"})
    EXPECT_THAT(with_units(std::string("ir,a,1,INT,") + cell + "\n", ""),
                HasSubstr("a: {address: 1, type: INT"))
        << cell;
}

TEST(CsvUnits, A_number_that_is_not_understood_is_an_error_where_units_scale) {
  for (const char* cell : {"0.1 to 5 V", "4-20 mA", "V 3 x 10 4"}) {
    for (const char* column : {"scaled_units", "divided_units"})
      EXPECT_THAT(with_units(std::string("ir,a,1,INT,") + cell + "\n", column),
                  HasSubstr("given:2:12: error: the number in the units '" + std::string(cell) +
                            "' is not understood"));
    EXPECT_THAT(with_units(std::string("ir,a,1,INT,") + cell + "\n", "units"), HasSubstr("units: ")) << cell;
  }
  for (const char* cell : {"m3/h", "1/min", "l/100km", "s^-1", "1 V"})
    EXPECT_THAT(with_units(std::string("ir,a,1,INT,") + cell + "\n", "scaled_units"), HasSubstr("units: "))
        << cell;
}

TEST(CsvUnits, A_scale_that_contradicts_the_units_is_an_error) {
  EXPECT_THAT(
      with_units("ir,a,1,INT,0.01V,0.1\n", "", ",Factor"),
      HasSubstr("given:2:12: error: the units '0.01V' and the scale 0.1 contradict each other; correct "
                "one of the two, or write --columns 'units=Unit' to take the units as they are"));
  EXPECT_THAT(with_units("ir,a,1,INT,0.01V,0.1\n", "units", ",Factor"),
              HasSubstr("units: \"0.01V\", scale: 0.1}"));
  EXPECT_THAT(with_units("ir,a,1,INT,0.1V,10\n", "", ",scale"), HasSubstr("contradict each other"));
}

TEST(CsvUnits, Units_may_say_what_a_gain_is) {
  const Imported csv("csv", "table,name,address,type,Unit,Gain\nir,a,1,UINT,0.1V,10\nir,b,2,UINT,A,100\n");
  EXPECT_THAT(csv.text(), HasSubstr("a: {address: 1, type: UINT, units: V, scale: 0.1}\n    b: {address: 2, "
                                    "type: UINT, units: A, scale: 0.01}"));
  EXPECT_THAT(csv.said, HasSubstr("'Gain' is read as a divisor, for the ranges and units in the table"));
  EXPECT_THAT(with_units("ir,a,1,UINT,0.1V,0.1\n", "", ",Gain"), HasSubstr("units: V, scale: 0.1}"));
  EXPECT_THAT(with_units("ir,a,1,UINT,x10,10\n", "", ",Gain"), HasSubstr("'Gain' has two meanings"));
}

TEST(CsvUnits, What_a_message_tells_to_write_is_what_the_option_takes) {
  EXPECT_THAT(Imported("csv", "table,name,address,type,\"Scale, factor\"\nir,a,1,UINT,10\n").said,
              HasSubstr("write --columns 'scale=\"Scale, factor\"' if"));
  EXPECT_THAT(Imported("csv", "table,name,address,type,Unit,\"Scale\nfactor\"\nir,a,1,UINT,V,10\n").said,
              HasSubstr("write --columns 'scale=Scale factor'"));
  formats::ImportOptions options{"m", {}};
  options.columns = {{"scale", "Scale factor"}};
  EXPECT_THAT(Imported("csv", "table,name,address,type,\"Scale\nfactor\"\nir,a,1,UINT,10\n", options).text(),
              HasSubstr("scale: 10}"));
  EXPECT_THAT(Imported("csv", "table,name,address,type,Description,Remarks\nir,a,1,UINT,x,y\n").said,
              HasSubstr("remove one, or leave it out with --columns 'ignore=Remarks'"));
  EXPECT_THAT(Imported("csv", "table,name,address,type,Units,Units\nir,a,1,UINT,x,y\n").said,
              HasSubstr("remove one, or give it another heading"));
}

TEST(CsvUnits, Unit_beside_the_unit_id_is_that_of_the_value) {
  const Imported csv("csv", "table,name,address,type,Unit,Slave\nir,a,1,UINT,V,7\n");
  EXPECT_THAT(csv.text(),
              HasSubstr("unit: 7\nmapping:\n  input_registers:\n    a: {address: 1, type: UINT, units: V}"));
}

}  // namespace
}  // namespace coupler::test
