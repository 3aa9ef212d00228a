// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include "test/host/tools/formats/imported.hpp"

namespace coupler::test {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(CsvImport, A_row_is_a_point_and_a_column_a_key_in_any_order) {
  const Imported csv("csv",
                     "Units,Type,Name,Address,Table,scale\n"
                     "rpm,INT,speed,7,holding_register,0.5\n"
                     ",,lamp,2,coils,\n");
  EXPECT_EQ(csv.said, "");
  EXPECT_EQ(csv.text(),
            "name: given\n"
            "mapping:\n"
            "  coils:\n"
            "    lamp: 2\n"
            "  holding_registers:\n"
            "    speed: {units: rpm, type: INT, address: 7, scale: 0.5}\n");
}

TEST(CsvImport, A_byte_order_mark_semicolons_and_decimal_commas_are_a_German_spreadsheet) {
  const Imported csv("csv",
                     "\xEF\xBB\xBFtable;name;address;type;scale\r\ninput_registers;level;0;INT;0,25\r\n");
  EXPECT_EQ(csv.said, "given:2:29: warning: '0,25' is read as 0.25; write a decimal point\n");
  ASSERT_EQ(csv.result.maps.size(), 1U);
  EXPECT_EQ(csv.result.maps[0].map->map().points[0].scale.gain, 0.25);
}

TEST(CsvImport, A_comma_in_a_text_is_no_decimal_comma) {
  const Imported csv(
      "csv", "table;name;address;type;length;initial;description\nholding_registers;s;0;STRING;8;1,5;2,5\n");
  EXPECT_EQ(csv.said, "");
  EXPECT_THAT(csv.text(), HasSubstr("initial: \"1,5\", description: \"2,5\""));
}

TEST(CsvImport, A_cell_may_hold_a_list_or_a_section_as_in_a_map) {
  const Imported csv("csv",
                     "table,name,address,type,scale,counter,line\n"
                     "discrete_inputs,pulse,0,,,,\"{chip: gpiochip0, offset: 4}\"\n"
                     "input_registers,parts,0,UINT,,{of: pulse},\n"
                     "input_registers,temp,1,INT,\"{gain: 0.1, offset: -40}\",,\n");
  EXPECT_EQ(csv.said, "");
  EXPECT_THAT(csv.text(), HasSubstr("parts: {address: 0, type: UINT, counter: {of: pulse}}"));
  EXPECT_THAT(csv.text(), HasSubstr("scale: {gain: 0.1, offset: -40}"));
}

TEST(CsvImport, The_column_unit_makes_a_map_of_each) {
  const std::string text = "unit,table,name,address\n1,coils,a,0\n2,coils,a,0\n1,coils,b,1\n";
  const Imported both("csv", text, {"bus", {}});
  ASSERT_EQ(both.result.maps.size(), 2U);
  EXPECT_EQ(both.text(0), "name: bus_1\nunit: 1\nmapping:\n  coils:\n    a: 0\n    b: 1\n");
  EXPECT_EQ(both.text(1), "name: bus_2\nunit: 2\nmapping:\n  coils:\n    a: 0\n");
  EXPECT_EQ(Imported("csv", text, {"bus", 2}).text(), both.text(1));
  EXPECT_THAT(Imported("csv", text, {"bus", 3}).said,
              HasSubstr("error: there is no unit 3 in the file; give one of 1, 2 with --unit"));
}

TEST(CsvImport, What_is_wrong_is_told_at_its_cell) {
  const Imported csv("csv",
                     "table,name,address,type\n"
                     "coils,a,0,\n"
                     "coil,b,zero,\n"
                     "holding_registers,c,1,INTT\n"
                     "registers,d,1,INT\n"
                     "input_registers,e,70000,INT\n"
                     "input_registers,f,9,INT,extra\n");
  EXPECT_TRUE(csv.result.maps.empty());
  for (const auto* place :
       {"given:3:8: error:", "given:4:23: error:", "given:5:1: error: 'registers' is not a table",
        "given:6:19: error:", "given:7:25: error: the row has 5 cells"})
    EXPECT_THAT(csv.said, HasSubstr(place));
}

TEST(CsvImport, Names_that_are_no_ROS_names_or_taken_are_mended_and_told) {
  const Imported csv(
      "csv", "table,name,address\ncoils,1st lamp,0\ncoils,lamp,1\ncoils,lamp,2\ncoils,status,3\ncoils,,4\n");
  EXPECT_THAT(
      csv.text(),
      HasSubstr("    point_1st_lamp: {address: 0, description: \"1st lamp\"}\n    lamp: 1\n    lamp_2: 2\n"
                "    status_point: {address: 3, description: status}\n    point: 4\n"));
  EXPECT_THAT(csv.said, HasSubstr("given:2:7: warning: '1st lamp' is not a valid name of a point and was "
                                  "changed to 'point_1st_lamp'"));
  EXPECT_THAT(csv.said, HasSubstr("given:4:7: warning: 'lamp' is already the name of the point in line 3, so "
                                  "this point is called 'lamp_2'"));
}

TEST(CsvImport, Two_points_at_one_place_are_told_with_both_lines) {
  EXPECT_THAT(Imported("csv", "table,name,address\ncoils,a,5\ncoils,b,5\n").said,
              HasSubstr("given:3:9: error: 'b' (coils 5) overlaps 'a' (coils 5, line 2)"));
}

TEST(CsvImport, A_column_that_no_point_has_is_told) {
  const Imported csv("csv", "table,name,address,Location,\ncoils,a,0,hall 3,\n");
  EXPECT_THAT(csv.said, HasSubstr("given:1:20: warning: the column 'Location' is not carried over"));
  EXPECT_EQ(csv.result.maps.size(), 1U);
}

TEST(CsvImport, A_column_that_is_nearly_a_key_is_an_error) {
  EXPECT_EQ(
      Imported("csv", "table,name,address,Unitz,\ncoils,a,0,V,\n").said,
      "given:1:20: error: a point has no key 'Unitz'; did you mean 'units'? If not, give the column another "
      "heading\n");
}

TEST(CsvImport, Types_are_read_under_all_their_names_and_written_under_that_of_IEC_61131_3) {
  formats::ImportOptions options;
  options.order = "CDAB";
  const Imported csv("csv",
                     "table,name,address,type,length,initial\n"
                     "holding_registers,a,0,uint32,,\n"
                     "holding_registers,b,2,Float,,\n"
                     "holding_registers,c,4,text,4,12\n"
                     "coils,d,0,boolean,,\n",
                     options);
  EXPECT_EQ(csv.said, "");
  EXPECT_THAT(csv.text(), HasSubstr("a: {address: 0, type: UDINT, order: CDAB}"));
  EXPECT_THAT(csv.text(), HasSubstr("b: {address: 2, type: REAL, order: CDAB}"));
  EXPECT_THAT(csv.text(), HasSubstr("c: {address: 4, type: STRING, length: 4, initial: \"12\"}"));
  EXPECT_THAT(csv.text(), HasSubstr("d: 0"));
  EXPECT_THAT(Imported("csv", "table,name,address,type\nholding_registers,a,0,LONG\n").said,
              HasSubstr("write DINT (32 bits) or LINT (64 bits)"));
}

TEST(CsvImport, Headings_and_words_are_those_that_people_write) {
  const Imported csv("csv",
                     "Tag;FC;Register;Data Type;R/W;Unit;Factor;Remarks\n"
                     "speed;HR;7;u16;R/W;rpm;0,5;of the belt\n"
                     "level;3x;1;s16;RO;mm;1;\n"
                     "lamp;0x;2;bool;RW;;;\n"
                     "door;discrete;3;bit;R;;;\n"
                     "go;FC3;9;uint16;WO;;;\n");
  EXPECT_THAT(csv.said, Not(HasSubstr("error")));
  const std::string text = csv.text();
  for (const char* line : {"speed: {address: 7, type: UINT, access: read_write, units: rpm, scale: 0.5, "
                           "description: \"of the belt\"}",
                           "level: {address: 1, type: INT, access: read, units: mm, scale: 1}",
                           "lamp: {address: 2, access: read_write}", "door: {address: 3, access: read}",
                           "go: {address: 9, type: UINT, access: write}"})
    EXPECT_THAT(text, HasSubstr(line));
}

// Makers of inverters call what a value was multiplied with the gain: Gain 10 is a register in tenths.
TEST(CsvImport, A_factor_that_may_be_a_divisor_is_asked_for) {
  for (const std::string heading :
       {"Gain", "gain", "Scale", "SCALE", "Scalefactor", "Scale Factor", "Scaling"})
    for (const char* cell : {"10", "0.1", "\"0,1\""}) {
      const std::string table =
          "table,name,address,type," + heading + "\nhr,a,1,INT,1\nhr,b,2,INT," + cell + "\n";
      const Imported csv("csv", table);
      EXPECT_THAT(csv.said, HasSubstr("given:1:25: error: '" + heading + "' has two meanings"));
      EXPECT_THAT(csv.said, HasSubstr("--columns 'scale=" + heading +
                                      "' if it is a factor, or --columns "
                                      "'divisor=" +
                                      heading + "'"));
      EXPECT_TRUE(csv.result.maps.empty());
    }
  // Both come to the same, and the map's own key has one meaning.
  EXPECT_EQ(Imported("csv", "table,name,address,type,Gain\nhr,a,1,INT,1\nhr,b,2,INT,\n").said, "");
  EXPECT_EQ(Imported("csv", "table,name,address,type,scale\nhr,a,1,INT,10\n").said, "");
  EXPECT_EQ(Imported("csv", "table,name,address,type,Factor\nhr,a,1,INT,10\n").said, "");
}

TEST(CsvImport, The_caller_says_that_a_column_is_a_divisor) {
  const std::string table =
      "table,name,address,type,Gain\nhr,a,1,INT,10\nhr,b,2,INT,1000\nhr,c,3,INT,\"0,1\"\n";
  formats::ImportOptions options{"m", {}};
  options.columns = {{"divisor", "Gain"}};
  const std::string divided = Imported("csv", table, options).text();
  for (const char* scale : {"address: 1, type: INT, scale: 0.1}", "scale: 0.001}", "scale: 10}"})
    EXPECT_THAT(divided, HasSubstr(scale));
  options.columns = {{"scale", "Gain"}};
  EXPECT_THAT(Imported("csv", table, options).text(), HasSubstr("b: {address: 2, type: INT, scale: 1000}"));
  const std::string wrong =
      Imported("csv", "table,name,address,type,Divisor\nhr,a,1,INT,0\nhr,b,2,INT,ten\n").said;
  EXPECT_THAT(wrong, HasSubstr("given:2:12: error: 'scale' must be a number other than 0"));
  EXPECT_THAT(wrong, HasSubstr("given:3:12: error: 'scale' must be a number"));
}

TEST(CsvImport, A_column_of_what_may_be_written_is_the_access) {
  const auto access = [](const std::string& heading, const std::string& cell) {
    const Imported csv("csv",
                       "table,name,address,type," + heading + "\nhr,a,1,INT," + cell + "\nhr,b,2,INT,1\n");
    return csv.result.maps.empty() ? csv.said : csv.text();
  };
  for (const char* heading : {"writable", "Writeable", "Can write"}) {
    for (const char* cell : {"yes", "TRUE", "1", "x", "RW", "Y", "\u2713"})
      EXPECT_THAT(access(heading, cell), HasSubstr("a: {address: 1, type: INT, access: read_write}")) << cell;
    for (const char* cell : {"no", "FALSE", "0", "", "-", "ro", "N", "n/a"})
      EXPECT_THAT(access(heading, cell), HasSubstr("a: {address: 1, type: INT, access: read}")) << cell;
  }
  EXPECT_THAT(access("read only", "yes"), HasSubstr("a: {address: 1, type: INT, access: read}"));
  EXPECT_THAT(access("ReadOnly", "no"), HasSubstr("a: {address: 1, type: INT, access: read_write}"));
  formats::ImportOptions options{"m", {}};
  options.columns = {{"access", "Writable"}};
  EXPECT_THAT(Imported("csv", "table,name,address,type,Writable\nhr,a,1,INT,no\n", options).text(),
              HasSubstr("access: read}"));
  EXPECT_THAT(access("writable", "perhaps"), HasSubstr("given:2:12: error: 'access' must be one of"));
  EXPECT_EQ(Imported("csv", "table,name,address,type,writable\nir,a,1,INT,no\nir,b,2,INT,\n").said, "");
}

// The codes are those of "Modbus Application Protocol V1.1b3", section 6.
TEST(CsvImport, Numbers_in_a_column_of_function_codes_name_the_table) {
  const std::pair<const char*, const char*> all[] = {
      {"1", "coils:\n    a: 7"},
      {"02", "discrete_inputs:\n    a: 7"},
      {"FC03", "holding_registers:\n    a: {address: 7, type: INT}"},
      {"fc 4", "input_registers:\n    a: {address: 7, type: INT}"},
      {"0x03 / 0x10", "holding_registers:\n    a: {address: 7, type: INT}"},
      {"01/05/15", "coils:\n    a: 7"},
      {"6", "holding_registers:\n    a: {address: 7, type: INT, access: write}"},
      {"5; 15", "coils:\n    a: {address: 7, access: write}"},
      {"4x", "holding_registers:\n    a: {address: 7, type: INT}"},
  };
  for (const auto& [code, point] : all) {
    const bool bits = std::string_view(point).find("INT") == std::string_view::npos;
    const std::string type = bits ? "" : "INT";
    for (const char* heading : {"FC", "Function Code"})
      EXPECT_THAT(
          Imported("csv", std::string(heading) + ",name,address,type\n\"" + code + "\",a,7," + type + "\n")
              .text(),
          HasSubstr(point))
          << code;
  }
  EXPECT_THAT(Imported("csv", "fc,name,address,access\n15,a,7,rw\n").text(), HasSubstr("access: read_write"));
  EXPECT_THAT(Imported("csv", "fc,name,address\n5,a,7\n").said,
              HasSubstr("given:2:1: warning: '5' only writes, so the point gets 'access: write'"));
}

// A table with 03 in one row and 03/06 in another says which of the two may be written.
TEST(CsvImport, Where_some_codes_write_a_point_with_reading_ones_only_is_read_only) {
  const Imported both("csv",
                      "name,FC,address,type\nactual,03,1,INT\nset,03/06,2,INT\nalarm,01,5,\nt,04,3,INT\n");
  EXPECT_EQ(both.said, "");
  for (const char* line : {"actual: {address: 1, type: INT, access: read}", "set: {address: 2, type: INT}",
                           "alarm: {address: 5, access: read}", "t: {address: 3, type: INT}"})
    EXPECT_THAT(both.text(), HasSubstr(line));
  // They name the table where none writes; and a column of its own says more.
  EXPECT_THAT(Imported("csv", "name,FC,address,type\na,03,1,INT\n").text(),
              HasSubstr("a: {address: 1, type: INT}"));
  EXPECT_THAT(Imported("csv", "name,FC,address,type,access\na,03,1,INT,rw\nb,06,2,INT,\n").text(),
              HasSubstr("a: {address: 1, type: INT, access: read_write}"));
}

TEST(CsvImport, A_number_with_two_meanings_is_refused_with_both) {
  const auto said = [](const std::string& heading, const std::string& cell) {
    return Imported("csv", heading + ",name,address,type\n\"" + cell + "\",a,7,INT\n").said;
  };
  EXPECT_THAT(said("table", "3"),
              HasSubstr("given:2:1: error: '3' alone is holding_registers as a function code and "
                        "input_registers as an area (3x); write FC3 or 3x, or call the column FC if it has"));
  EXPECT_THAT(said("area", "4"),
              HasSubstr("input_registers as a function code and holding_registers as an area (4x)"));
  EXPECT_THAT(said("table", "1"), HasSubstr("coils as a function code and discrete_inputs as an area (1x)"));
  EXPECT_THAT(said("table", "2"), HasSubstr("'2' alone is discrete_inputs as a function code; write FC2"));
  EXPECT_THAT(said("table", "0"), HasSubstr("'0' alone is coils as an area (0x); write 0x"));
  EXPECT_THAT(said("fc", "3/4"),
              HasSubstr("'3/4' is holding_registers and input_registers; give each of the two a row"));
  EXPECT_THAT(said("fc", "7"), HasSubstr("'7' is not a function code that reads or writes a table"));
  EXPECT_THAT(said("table", "9"), HasSubstr("'9' is not a table; write coils"));
  EXPECT_THAT(said("table", "16"),
              HasSubstr("'16' alone is holding_registers as a function code; write FC16, or call"));
  EXPECT_THAT(said("table", "35"), HasSubstr("'35' is not a table; write coils"));
}

TEST(CsvImport, A_column_unit_with_text_is_units_and_with_numbers_the_unit_id) {
  EXPECT_THAT(Imported("csv", "table,name,address,type,Unit\nhr,a,0,INT,bar\nhr,b,1,INT,\n").text(),
              HasSubstr("a: {address: 0, type: INT, units: bar}"));
  EXPECT_THAT(Imported("csv", "table,name,address,type,Unit\nhr,a,0,INT,3\n").text(), HasSubstr("unit: 3\n"));
}

TEST(CsvImport, Modicon_addresses_say_the_table_and_stay_as_they_are) {
  formats::ImportOptions options{"m", {}};
  options.addressing = loader::Addressing::modicon;
  const Imported csv(
      "csv", "name,address,type\nlamp,00001,\ndoor,10003,\nlevel,30001,INT\nspeed,400002,INT\n", options);
  EXPECT_EQ(csv.said, "");
  EXPECT_THAT(csv.text(), HasSubstr("addressing: modicon"));
  ASSERT_EQ(csv.result.maps.size(), 1U);
  const Map& map = csv.result.maps[0].map->map();
  EXPECT_EQ(find(map, "lamp")->table, Table::coils);
  EXPECT_EQ(find(map, "door")->address, 2);
  EXPECT_EQ(find(map, "level")->table, Table::input_registers);
  EXPECT_EQ(find(map, "speed")->address, 1);
}

TEST(CsvImport, Headings_of_other_languages_are_named_by_the_caller) {
  const std::string table = "Bezeichnung;Bereich;Adresse\nLampe;coils;3\n";
  EXPECT_THAT(Imported("csv", table).said, HasSubstr("there is no column 'name'"));
  formats::ImportOptions options{"m", {}};
  options.columns = {{"name", "bezeichnung"}, {"table", "Bereich"}, {"address", "Adresse"}};
  EXPECT_THAT(Imported("csv", table, options).text(), HasSubstr("Lampe: 3"));
  options.columns.push_back({"type", "Typ"});
  EXPECT_THAT(Imported("csv", table, options).said, HasSubstr("--columns: there is no heading 'Typ'"));
}

TEST(CsvImport, Latin_1_and_UTF_16_are_read_as_Excel_saves_them) {
  const std::string head = "table,name,address,description\n";
  const Imported latin("csv", head + "coils,a,0,T\xFCr f\xFCr 5 \x80\n");
  EXPECT_THAT(latin.said, HasSubstr("read as Windows-1252 (Latin-1)"));
  ASSERT_EQ(latin.result.maps.size(), 1U);
  EXPECT_EQ(latin.result.maps[0].map->map().points[0].description, "Tür für 5 €");
  for (const bool big_endian : {false, true}) {
    std::string bytes = big_endian ? "\xFE\xFF" : "\xFF\xFE";
    for (const char16_t unit :
         std::u16string(u"table\tname\taddress\tdescription\r\ncoils\ta\t0\tTür 🔧\r\n")) {
      const char high = static_cast<char>(unit >> 8);
      const char low = static_cast<char>(unit & 0xFF);
      bytes += big_endian ? high : low;
      bytes += big_endian ? low : high;
    }
    const Imported wide("csv", bytes);
    EXPECT_EQ(wide.said, "");
    ASSERT_EQ(wide.result.maps.size(), 1U);
    EXPECT_EQ(wide.result.maps[0].map->map().points[0].description, "Tür 🔧");
  }
}

TEST(CsvImport, A_name_that_had_to_change_is_kept_as_the_description) {
  EXPECT_THAT(Imported("csv", "table,name,address\ncoils,Lamp 1,0\n").text(),
              HasSubstr("Lamp_1: {address: 0, description: \"Lamp 1\"}"));
  EXPECT_THAT(Imported("csv", "table,name,address,description\ncoils,Lamp 1,0,above the door\n").text(),
              HasSubstr("Lamp_1: {address: 0, description: \"above the door\"}"));
}

TEST(CsvImport, A_table_without_headings_or_without_points_is_refused) {
  EXPECT_THAT(Imported("csv", "coils,a,0\ncoils,b,1\n").said, HasSubstr("error: there is no column 'table'"));
  EXPECT_THAT(Imported("csv", "table,name,address\n").said,
              HasSubstr("error: there are no points in the file"));
  EXPECT_THAT(Imported("csv", "").said, HasSubstr("error: there are no points in the file"));
  EXPECT_THAT(Imported("csv", "table,table,name,address\ncoils,coils,a,0\n").said,
              HasSubstr("error: the column 'table' is there twice"));
}

}  // namespace
}  // namespace coupler::test
