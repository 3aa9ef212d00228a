// SPDX-License-Identifier: Apache-2.0
// The form of the samples is what ModbusPal saves: its modbuspal.dtd, ModbusPalProject.saveProject() and the
// projects in github.com/zeelos/ModbusPal and github.com/BRoessl/modbuspal-runtime (samples/project02.xmpp).
#include <gmock/gmock.h>

#include "test/host/tools/formats/imported.hpp"

namespace coupler::test {
namespace {

using testing::HasSubstr;
using testing::Not;

std::string project(const std::string& slaves, const std::string& declaration =
                                                   "<!DOCTYPE modbuspal_project SYSTEM \"modbuspal.dtd\">") {
  return "<?xml version=\"1.0\" encoding=\"ISO-8859-1\" ?>\r\n" + declaration +
         "\r\n<modbuspal_project>\r\n<idgen  value=\"2\"/>\r\n<links selected=\"TCP/IP\" >\r\n<tcpip "
         "port=\"503\" />\r\n</links>\r\n" +
         slaves + "\r\n</modbuspal_project>\r\n";
}

std::string slave(const std::string& parts, const std::string& id = "1") {
  return project("<slave id=\"" + id + "\" enabled=\"true\" implementation=\"modbus\">\r\n" + parts +
                 "\r\n</slave>");
}

std::string registers(const std::string& lines) {
  return slave("<holding_registers>\r\n" + lines + "\r\n</holding_registers>");
}

TEST(ModbusPalImport, A_saved_project_becomes_a_map) {
  const Imported imported("modbuspal",
                          slave("<holding_registers>\r\n"
                                "<register address=\"100\" value=\"123\"/>\r\n"
                                "<register address=\"101\" value=\"-2\" name=\"set point\"/>\r\n"
                                "<register address=\"102\" value=\"0\">\r\n"
                                "<binding automation=\"ramp\" class=\"Binding_SINT16\" order=\"0\"/>\r\n"
                                "</register>\r\n</holding_registers>\r\n"
                                "<coils>\r\n<coil address=\"4\" value=\"1\" name=\"lamp\"/>\r\n</coils>\r\n"
                                "<tuning>\r\n<reply_delay min=\"0\" max=\"0\" />\r\n</tuning>",
                                "127.0.0.1(23)"));
  EXPECT_EQ(imported.text(),
            "name: given\n"
            "address: \"127.0.0.1\"\n"
            "port: 503\n"
            "unit: 23\n"
            "mapping:\n"
            "  coils:\n"
            "    lamp: {address: 4, initial: on}\n"
            "  holding_registers:\n"
            "    hr_100: {address: 100, type: UINT, initial: 123}\n"
            "    set_point: {address: 101, type: UINT, initial: 65534, description: \"set point\"}\n"
            "    hr_102: {address: 102, type: INT}\n");
  EXPECT_THAT(
      imported.said,
      HasSubstr(
          "given:11:2: warning: 'set point' is not a valid name of a point and was changed to 'set_point'"));
  EXPECT_THAT(imported.said, HasSubstr("given:13:2: warning: the automation 'ramp' is not carried over"));
  EXPECT_THAT(imported.said, HasSubstr("warning: 'tuning' of the slave is not carried over"));
}

TEST(ModbusPalImport, Two_registers_of_one_fed_value_are_one_point_in_their_order) {
  const auto fed = [](int address, const std::string& type, int order) {
    return "<register address=\"" + std::to_string(address) + "\" value=\"0\" name=\"r" +
           std::to_string(address) + "\"><binding automation=\"a\" class=\"Binding_" + type + "\" order=\"" +
           std::to_string(order) + "\"/></register>";
  };
  const Imported imported("modbuspal",
                          registers(fed(0, "SINT32", 0) + fed(1, "SINT32", 1) + fed(2, "FLOAT32", 1) +
                                    fed(3, "FLOAT32", 0) + fed(8, "FLOAT32", 0) + fed(10, "FLOAT32", 1)));
  EXPECT_THAT(imported.text(), HasSubstr("    r0: {address: 0, type: DINT, order: CDAB}\n"
                                         "    r2: {address: 2, type: REAL, order: ABCD}\n"
                                         "    r8: {address: 8, type: UINT}\n"
                                         "    r10: {address: 10, type: UINT}\n"));
  EXPECT_THAT(imported.said, HasSubstr("the other register of a REAL is not next to this one"));
}

TEST(ModbusPalImport, Doubles_and_wrong_numbers_are_told) {
  EXPECT_THAT(Imported("modbuspal", registers("<register address=\"5\"/><register address=\"5\"/>")).said,
              HasSubstr("register 5 is there twice"));
  EXPECT_THAT(Imported("modbuspal", registers("<register address=\"65536\"/>")).said,
              HasSubstr("given:10:2: error: '65536' is not an address"));
  EXPECT_THAT(Imported("modbuspal", registers("<register address=\"1\" value=\"70000\"/>")).said,
              HasSubstr("error: the value '70000' is not a register value"));
  EXPECT_THAT(Imported("modbuspal", slave("", "seven")).said, HasSubstr("error: 'seven' is not a unit id"));
  EXPECT_THAT(Imported("modbuspal", project("")).said, HasSubstr("error: there is no slave in the project"));
}

TEST(ModbusPalImport, Several_slaves_are_several_maps) {
  const Imported both(
      "modbuspal",
      project("<slave id=\"1\"><coils><coil address=\"0\"/></coils></slave><slave id=\"2\" enabled=\"false\">"
              "<coils><coil address=\"1\"/></coils></slave>"));
  ASSERT_EQ(both.result.maps.size(), 2U);
  EXPECT_EQ(both.text(0), "name: given_1\nport: 503\nunit: 1\nmapping:\n  coils:\n    coil_0: 0\n");
  EXPECT_THAT(both.said, HasSubstr("the slave is switched off in the project"));
}

TEST(ModbusPalImport, A_slave_without_points_beside_others_is_left_out) {
  const Imported one(
      "modbuspal", project("<slave id=\"1\"><coils><coil address=\"0\"/></coils></slave><slave id=\"2\"/>"));
  ASSERT_EQ(one.result.maps.size(), 1U);
  EXPECT_THAT(one.said, HasSubstr("warning: unit 2 has no points, so there is no map of it"));
  EXPECT_THAT(Imported("modbuspal", project("<slave id=\"2\"/>")).said,
              HasSubstr("error: the map has no points"));
}

TEST(ModbusPalImport, Entities_are_never_read) {
  const std::string laughs =
      "<!DOCTYPE modbuspal_project [<!ENTITY a \"ha\"><!ENTITY b \"&a;&a;&a;&a;&a;&a;&a;&a;\">"
      "<!ENTITY c \"&b;&b;&b;&b;&b;&b;&b;&b;\">]>";
  const std::string with = "<slave id=\"1\"><coils><coil address=\"0\" name=\"&c;\"/></coils></slave>";
  EXPECT_THAT(Imported("modbuspal", project(with, laughs)).said, HasSubstr("given:2:"));
  EXPECT_THAT(Imported("modbuspal", project(with, laughs)).said,
              HasSubstr("error: the file declares entities of its own"));
  const std::string external = "<!DOCTYPE modbuspal_project [<!ENTITY c SYSTEM \"file:///etc/passwd\">]>";
  EXPECT_TRUE(Imported("modbuspal", project(with, external)).result.maps.empty());
  const Imported undeclared("modbuspal", project(with));
  EXPECT_THAT(undeclared.text(),
              HasSubstr("    c: {address: 0, description: \"&c;\"}\n"));  // the name is "&c;", mended
}

TEST(ModbusPalImport, What_is_no_project_is_refused_where_it_breaks) {
  EXPECT_THAT(Imported("modbuspal", slave("<coils>").substr(0, 200)).said,
              HasSubstr("error: this is not XML: "));
  EXPECT_THAT(Imported("modbuspal", "<html></html>").said,
              HasSubstr("error: there is no <modbuspal_project> in the file"));
  EXPECT_THAT(Imported("modbuspal", "").said, HasSubstr("error: this is not XML"));
  std::string deep;
  for (int i = 0; i < 100000; ++i) deep += "<a>";
  EXPECT_THAT(Imported("modbuspal", deep).said, HasSubstr("error: this is not XML"));
}

}  // namespace
}  // namespace coupler::test
