// SPDX-License-Identifier: Apache-2.0
// Numbers that mean several things: thousands, exponents, counts and lengths; and cells that mean none.
#include <gmock/gmock.h>

#include <algorithm>

#include "test/host/tools/formats/imported.hpp"

namespace coupler::test {
namespace {

using testing::AllOf;
using testing::AnyOf;
using testing::HasSubstr;
using testing::Not;

using Choices = std::vector<formats::ColumnNames>;

/// The map with what is told, or what is said.
std::string made_of(const std::string& table, const Choices& columns = {}) {
  formats::ImportOptions options{"m", {}};
  options.order = "ABCD";
  options.columns = columns;
  const Imported csv("csv", table, options);
  return csv.result.maps.empty() ? csv.said : csv.text() + csv.said;
}

TEST(CsvNumbers, Three_digits_behind_a_sign_in_an_address_are_asked_for) {
  const auto at = [](const std::string& address, const std::string& type) {
    return made_of("table,name,address,type\nhr,a,\"" + address + "\"," + type + "\n");
  };
  EXPECT_THAT(at("1,002", "DINT"),
              HasSubstr("given:2:6: error: '1,002' has two readings: 1002 with a sign between "
                        "the thousands, or the addresses 1 and 002; write 1002 if that"));
  EXPECT_THAT(at("40,041", "REAL"), HasSubstr("'40,041' has two readings: 40041 "));
  EXPECT_THAT(at("1.002", "BOOL"),
              HasSubstr("'1.002' has two readings: 1002 with a sign between the thousands, or "
                        "the bit 2 of register 1"));
  EXPECT_THAT(at("40.003", "INT"), HasSubstr("'40.003' has two readings"));
  EXPECT_THAT(at("3,4", "DINT"), HasSubstr("a: {address: 3, type: DINT, order: ABCD}"));
  EXPECT_THAT(at("20.03", "BOOL"), HasSubstr("a: {address: 20, type: BOOL, bit: 3}"));
  EXPECT_THAT(at("4:115", "INT"), HasSubstr("'4:115' has two readings"));
  EXPECT_THAT(at("4:99", "INT"), Not(HasSubstr("bit: 99")));
}

TEST(CsvNumbers, Thousands_in_a_range_are_asked_for) {
  const auto range = [](const std::string& cell, const char separator) {
    std::string head = "table,name,address,type,Range\nhr,a,1,REAL,";
    std::replace(head.begin(), head.end(), ',', separator);
    return made_of(head + "\"" + cell + "\"\n");
  };
  for (const char* cell : {"0 - 1,000", "0-1,500", "1,000 to 2,000"}) {
    EXPECT_THAT(range(cell, ','), HasSubstr("given:2:13: error: a number of the range '" + std::string(cell) +
                                            "' has two readings"));
    EXPECT_THAT(range(cell, ','), HasSubstr("--columns 'ignore=Range'"));
  }
  EXPECT_THAT(range("0 bis 1.000", ';'), HasSubstr("has two readings"));
  EXPECT_THAT(range("1.000 to 2.000", ','), HasSubstr("min: 1.000, max: 2.000,"));
  EXPECT_THAT(range("0-0,125", ';'), HasSubstr("min: 0, max: 0.125,"));
  EXPECT_THAT(range("0,5-1,5", ','), HasSubstr("min: 0.5, max: 1.5,"));
  EXPECT_THAT(range("0,1,2", ','), HasSubstr("given:2:13: warning: the range '0,1,2' is not carried over"));
}

TEST(CsvNumbers, Thousands_in_any_number_are_asked_for) {
  for (const char* heading : {"Max", "Factor", "Raw offset"}) {
    const std::string column = heading;
    EXPECT_THAT(
        made_of("table,name,address,type," + column + "\nhr,a,1,INT,\"1,000\"\n"),
        HasSubstr("given:2:12: error: '1,000' has two readings: 1000, with a sign between the thousands, or "
                  "1.000; write 1000, or 1.0000"))
        << heading;
    EXPECT_THAT(made_of("table;name;address;type;" + column + "\nhr;a;1;REAL;1.000\n"),
                HasSubstr("'1.000' has two readings"));
    EXPECT_THAT(made_of("table,name,address,type," + column + "\nhr,a,1,REAL,1.250\n"), HasSubstr("1.25"));
    EXPECT_THAT(made_of("table;name;address;type;" + column + "\nhr;a;1;REAL;0.125\n"), HasSubstr("0.125"));
    EXPECT_THAT(made_of("table;name;address;type;" + column + "\nhr;a;1;REAL;1,250\n"), HasSubstr("1.25"));
  }
}

TEST(CsvNumbers, An_exponent_of_ten_is_the_third_reading_of_a_scale_factor) {
  const std::string table =
      "table,name,address,type,Scale Factor\nhr,a,1,INT,-1\nhr,b,2,UINT,-2\nhr,c,3,INT,0\n";
  EXPECT_THAT(
      made_of(table),
      HasSubstr(
          "given:1:25: error: 'Scale Factor' has three meanings: with '-1', a register is multiplied by "
          "it, or divided, or it is an exponent: a register x 10^-1; write --columns 'exponent=Scale "
          "Factor' if it is an exponent of ten"));
  const std::string exponents = made_of(table, {{"exponent", "Scale Factor"}});
  for (const char* line :
       {"a: {address: 1, type: INT, scale: 0.1}", "b: {address: 2, type: UINT, scale: 0.01}",
        "c: {address: 3, type: INT, scale: 1}"})
    EXPECT_THAT(exponents, HasSubstr(line));
  EXPECT_THAT(made_of("table,name,address,type,Exponent\nhr,a,1,INT,0.5\n"), HasSubstr("given:2:12: error:"));
  EXPECT_THAT(made_of("table,name,address,type,Scale Factor\nhr,a,1,INT,0\n"),
              HasSubstr("a: {address: 1, type: INT}"));
  EXPECT_THAT(made_of("table,name,address,type,Scale\nhr,a,1,INT,10\n"), HasSubstr("has two meanings"));
}

TEST(CsvNumbers, An_offset_of_the_address_is_asked_for) {
  const std::string table = "table,name,address,Address Offset,type\nhr,a,71,2,INT\n";
  EXPECT_THAT(made_of(table),
              HasSubstr("given:1:20: error: 'Address Offset' has two meanings: '2' is to be added to "
                        "the address, or it is in the address already"));
  EXPECT_THAT(made_of(table, {{"address_offset", "Address Offset"}}), HasSubstr("address: 73,"));
  EXPECT_THAT(made_of(table, {{"ignore", "Address Offset"}}), HasSubstr("address: 71,"));
}

TEST(CsvNumbers, An_offset_may_be_added_before_the_factor) {
  EXPECT_THAT(
      made_of("table,name,address,type,Factor,Offset\nhr,a,1,INT,0.1,-1000\n", {{"raw_offset", "Offset"}}),
      HasSubstr("scale: {gain: 0.1, offset: -100}"));
}

TEST(CsvNumbers, A_count_that_every_type_fits_is_that_of_registers) {
  const std::string head = "table,name,address,type,Count\n";
  const std::string made = made_of(head + "hr,a,1,U32,2\nhr,b,3,U16,1\nhr,c,4,Float,2\n");
  EXPECT_THAT(made, HasSubstr("a: {address: 1, type: UDINT, order: ABCD}"));
  EXPECT_THAT(made, Not(HasSubstr("count")));
  EXPECT_THAT(made_of(head + "hr,a,1,U16,8\n"), HasSubstr("count: 8"));
  EXPECT_THAT(made_of(head + "hr,a,1,U32,2\nhr,b,3,STR,4\n"), HasSubstr("length: 8"));
  EXPECT_THAT(
      made_of(head + "hr,a,1,STR,8\nhr,b,9,U16,1\n"),
      HasSubstr("'Count' has two meanings: 8 beside 'STR' is the number of bytes, or of registers; write "
                "--columns 'length=Count' for bytes, or --columns 'quantity=Count' for registers"));
  const std::string open = head + "hr,a,1,U32,4\nhr,b,9,U16,1\n";
  EXPECT_THAT(made_of(open),
              HasSubstr("given:1:25: error: 'Count' has two meanings: 4 beside 'U32' is the number of "
                        "values of an array, or of registers; write --columns 'count=Count' for "
                        "values of an array, or --columns 'quantity=Count' for registers"));
  EXPECT_THAT(made_of(open, {{"count", "Count"}}), HasSubstr("count: 4"));
  EXPECT_THAT(made_of("table,name,address,type,count\nhr,a,1,U32,2\n"),
              HasSubstr("count: 2"));  // the map's key
}

TEST(CsvNumbers, A_length_is_of_bytes_or_of_registers) {
  const std::string head = "table,name,address,type,Length\n";
  EXPECT_THAT(made_of(head + "hr,a,1,U32,2\nhr,b,3,STR,8\n"), HasSubstr("type: STRING, length: 16}"));
  EXPECT_THAT(made_of(head + "hr,a,1,U32,4\nhr,b,3,STR,8\n"), HasSubstr("type: STRING, length: 8}"));
  EXPECT_THAT(made_of(head + "hr,a,1,U32,2\n"), HasSubstr("a: {address: 1, type: UDINT, order: ABCD}"));
  // By the addresses alone.
  EXPECT_THAT(made_of(head + "hr,a,20,STR,8\nhr,b,28,STR,5\n"),
              HasSubstr("a: {address: 20, type: STRING, length: 16}"));
  EXPECT_THAT(made_of(head + "hr,a,20,STR,8\nhr,b,24,STR,5\n"),
              HasSubstr("a: {address: 20, type: STRING, length: 8}"));
  EXPECT_THAT(
      made_of(head + "hr,a,20,STR,8\nhr,b,24,STR,5\n"),
      HasSubstr("given:1:25: warning: 'Length' is read as the number of bytes, for types and addresses fit "
                "only that; if that is wrong, write --columns 'quantity=Length'"));
  const std::string open = head + "hr,a,20,STR,8\nhr,b,40,INT,\n";
  EXPECT_THAT(made_of(open),
              HasSubstr("given:1:25: error: 'Length' has two meanings: 8 is the number of bytes of a "
                        "text, or of registers, which hold 16"));
  EXPECT_THAT(made_of(open, {{"length", "Length"}}), HasSubstr("length: 8}"));
  EXPECT_THAT(made_of(open, {{"quantity", "Length"}}), HasSubstr("length: 16}"));
}

TEST(CsvNumbers, Where_a_number_may_stand_some_words_are_an_empty_cell) {
  for (const char* nothing : {"N/A", "n/a", "-", "--", "None", "–"}) {
    const std::string word = nothing;
    EXPECT_THAT(made_of("table,name,address,type,Scale,Range,Quantity\nhr,a,1,INT,0.1,0..5,1\nhr,b,2,INT," +
                            word + "," + word + "," + word + "\n",
                        {{"scale", "Scale"}}),
                HasSubstr("b: {address: 2, type: INT}"))
        << word;
    EXPECT_THAT(made_of("table,name,address,type\nhr,a," + word + ",INT\n"),
                HasSubstr("given:2:6: error: the point has no address"));
  }
  EXPECT_THAT(made_of("table,name,address,type,Unit\nhr,a,1,INT,nA\nhr,b,2,INT,NA\n"),
              HasSubstr("a: {address: 1, type: INT, units: nA}\n    b: {address: 2, type: INT}"));
  EXPECT_THAT(made_of("table,name,address,type,Scaling\nhr,a,1,INT,0.1\nhr,b,2,INT,N/A\n"),
              HasSubstr("'Scaling' has two meanings: with '0.1'"));
  EXPECT_THAT(
      made_of(
          "table,name,address,type,Scaling,Raw Low,Raw High,Scaled Low,Scaled High\nhr,a,1,INT,0.1,,,,\n"),
      HasSubstr("'Scaling' has two meanings: with '0.1'"));
}

TEST(CsvNumbers, A_line_with_some_of_its_numbers_is_told) {
  EXPECT_THAT(
      made_of("table,name,address,type,Raw Low,Raw High,Scaled Low,Scaled High\nhr,a,1,INT,0,1000,,\n"),
      HasSubstr("given:2:14: warning: the value is not scaled, for only some of the four numbers are there"));
}

TEST(CsvNumbers, A_range_of_the_register_says_nothing) {
  const std::string head = "table,name,address,type,Scale,Range\n";
  const std::string made =
      made_of(head + "hr,a,1,INT16,0.1,-32768..32767\nhr,b,2,UINT16,0.1,0..65535\n", {{"scale", "Scale"}});
  EXPECT_THAT(made, HasSubstr("a: {address: 1, type: INT, scale: 0.1}"));
  EXPECT_THAT(made, HasSubstr("b: {address: 2, type: UINT, scale: 0.1}"));
  EXPECT_THAT(made_of(head + "hr,a,1,UINT,10,0..65535\n"), HasSubstr("'Scale' has two meanings"));
}

TEST(CsvNumbers, A_range_that_a_map_does_not_have_is_left_out) {
  const auto range = [](const std::string& cell) {
    return made_of("table,name,address,type,Range\nhr,a,1,INT," + cell + "\n");
  };
  for (const char* cell :
       {"100", "0/1", "0=Off;1=stand by", "0=", "> 0", "± 100", "low", "0..", "..5", "0 to", "on/off"}) {
    EXPECT_THAT(range(cell), HasSubstr("given:2:12: warning: the range '" + std::string(cell) +
                                       "' is not carried over: it is not two numbers"));
    EXPECT_THAT(range(cell), HasSubstr("a: {address: 1, type: INT}"));
  }
  for (const char* cell : {"0=off;1=on;2=reserved;3=reserved", "0=off;1=on;0x01=run", "0=off;32768=on"}) {
    const std::string made = range(cell);
    EXPECT_THAT(made, HasSubstr("given:2:12: warning: the range '" + std::string(cell) + "' is not carried"));
    EXPECT_THAT(made, HasSubstr("a: {address: 1, type: INT}")) << "the loader refuses such values";
  }
  const std::string named = "0=Off;1=On";
  EXPECT_THAT(
      made_of("table,name,address,type,Range\nhr,a,1,REAL," + named + "\nhr,b,3,WORD," + named + "\n", {}),
      AllOf(HasSubstr("given:2:13: warning"), HasSubstr("given:3:13: warning")));
  EXPECT_THAT(made_of("table,name,address,type,Factor,Range\nhr,a,1,INT,0.1," + named + "\n"),
              HasSubstr("is not carried over"));
  for (const char* cell : {"0 à 100", "von 0 bis 100", "from 0 to 100", "de 0 à 100"})
    EXPECT_THAT(range(cell), HasSubstr("min: 0, max: 100}")) << cell;
  EXPECT_THAT(made_of("table,name,address,type,Range\nhr,a,1,INT,0..5\n", {{"ignore", "Range"}}),
              HasSubstr("a: {address: 1, type: INT}"));
}

TEST(CsvNumbers, A_range_of_names_is_the_names_of_values) {
  const std::string head = "table;name;address;type;Range\n";
  for (const char* cell : {"\"0=Off;1=On\"", "0: Off, 1: On", "0 = Off | 1 = On", "0=Off/1=On;"}) {
    const std::string made =
        made_of(head + "hr;a;1;UINT;" + (cell[0] == '"' ? cell : '"' + std::string(cell) + '"') + "\n");
    EXPECT_THAT(made, HasSubstr("a: {address: 1, type: UINT, values: {0: Off, 1: On}}")) << cell;
    EXPECT_THAT(made, Not(HasSubstr("warning"))) << cell;
  }
  EXPECT_THAT(made_of("table;name;address;type;Factor;Range\nhr;a;1;UINT;1;0=Off\n"),
              HasSubstr("values: {0: Off}"));
}

TEST(CsvNumbers, An_exponent_beside_a_factor_is_another_factor) {
  const std::string rows =
      "hr,a,1,INT,5,-2\nhr,b,2,INT,3,\nhr,c,3,INT,,-1\nhr,d,4,INT,3,-1\nhr,e,5,INT,7,0\n";
  const std::string made = made_of("table,name,address,type,Factor,Exponent\n" + rows);
  for (const char* line : {"a: {address: 1, type: INT, scale: 0.05}", "b: {address: 2, type: INT, scale: 3}",
                           "c: {address: 3, type: INT, scale: 0.1}", "d: {address: 4, type: INT, scale: 0.3}",
                           "e: {address: 5, type: INT, scale: 7}"})
    EXPECT_THAT(made, HasSubstr(line));
  EXPECT_THAT(made_of("table,name,address,type,Exponent,Divisor\nhr,a,1,INT,2,5\nhr,b,2,INT,-,5\n"),
              AllOf(HasSubstr("scale: 20}"), HasSubstr("scale: 0.2}")));
  EXPECT_THAT(
      made_of("table,name,address,type,Factor,Exponent\nhr,a,1,INT,5,0.5\n"),
      HasSubstr("given:2:14: error: '0.5' is not an exponent of ten; write a whole number from -30 to "
                "30, or nothing"));
  EXPECT_THAT(made_of("table,name,address,type,Gain,Exponent\nhr,a,1,INT,5,1\n"), HasSubstr("is there twice"))
      << "a gain may divide";
}

TEST(CsvNumbers, A_factor_of_1_beside_what_has_none_is_no_scale) {
  const std::string made = made_of(
      "table,name,address,type,Factor,Quantity\nhr,a,1,STR,1,4\nhr,b,9,WORD,1,1\ncoils,c,1,,1,\nhr,d,10.3,,1,"
      "\n");
  EXPECT_THAT(made, Not(HasSubstr("scale")));
  EXPECT_THAT(made, HasSubstr("b: {address: 9, type: WORD}"));
}

TEST(CsvNumbers, A_word_with_a_scale_is_a_number) {
  const std::string made =
      made_of("table,name,address,type,Factor\nhr,a,1,Word,0.1\nhr,b,2,DWord,0.1\nhr,c,4,Word,\n");
  EXPECT_THAT(made, HasSubstr("a: {address: 1, type: UINT, scale: 0.1}"));
  EXPECT_THAT(made, HasSubstr("b: {address: 2, type: UDINT, scale: 0.1, order: ABCD}"));
  EXPECT_THAT(made, HasSubstr("c: {address: 4, type: WORD}"));
  EXPECT_THAT(
      made, HasSubstr("given:2:8: warning: 'Word' is scaled, so the point is UINT, a number; write the type "
                      "INT if it has a sign"));
}

TEST(CsvNumbers, A_factor_may_be_a_fraction_or_a_power) {
  for (const char* factor : {"1/10", "10^-1", "1:10", "0.1"}) {
    const std::string made =
        made_of("table,name,address,type,Faktor\nhr,a,1,INT," + std::string(factor) + "\n");
    EXPECT_THAT(made, AnyOf(HasSubstr("scale: 0.1}"), HasSubstr("scale: 1e-1}"))) << factor;
  }
  EXPECT_THAT(made_of("table,name,address,type,Skalierung\nhr,a,1,INT,10\n"),
              HasSubstr("'Skalierung' has two meanings"));
}

}  // namespace
}  // namespace coupler::test
