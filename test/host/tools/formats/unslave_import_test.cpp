// SPDX-License-Identifier: Apache-2.0
// The form of the samples is that of the Unslave User Manual, https://unserver.xyz/docs/unslave ("Simulating
// a Modbus RTU Slave", "Simulating Modbus Exceptions", "Simulating Modbus TCP Slaves"), keys, values and all.
#include <gmock/gmock.h>

#include "test/host/tools/formats/imported.hpp"

namespace coupler::test {
namespace {

using testing::HasSubstr;

TEST(UnslaveImport, The_manuals_serial_slave_is_a_skeleton_of_a_map) {
  const Imported imported("unslave", R"({
  "port": { "name": "COM1", "baudRate": 115200, "dataBits": 8, "parity": "none", "stopBits": 1 },
  "slaves": {
    "1": {
      "isOnline": true,
      "registers": { "HR0": 1, "HR10": "0x0A", "C0": true }
    }
  }
})");
  EXPECT_EQ(imported.text(),
            "name: given\n"
            "unit: 1\n"
            "serial: {device: COM1, baud: 115200, parity: none, stop_bits: 1}\n"
            "mapping:\n"
            "  coils:\n"
            "    c_0: {address: 0, initial: on}\n"
            "  holding_registers:\n"
            "    hr_0: {address: 0, type: UINT, initial: 1}\n"
            "    hr_10: {address: 10, type: UINT, initial: 10}\n");
  EXPECT_THAT(imported.said, HasSubstr("given:2:21: warning: 'COM1' is not a device file of Linux"));
  EXPECT_THAT(imported.said, HasSubstr("given:3:3: warning: Unslave has no types and no names"));
}

TEST(UnslaveImport, An_exception_is_told_and_the_register_stays) {
  const Imported imported("unslave", R"({
  "mode": "TCP", "tcpPort": 9002, "version": "3.0.3", // comments are allowed
  "slaves": { "1": { "isOnline": true,
    "registers": { "HR0": 1,
                   "HR1": { exception: 4 } } } }
})");
  EXPECT_EQ(imported.text(),
            "name: given\nport: 9002\nunit: 1\nmapping:\n  holding_registers:\n"
            "    hr_0: {address: 0, type: UINT, initial: 1}\n    hr_1: {address: 1, type: UINT}\n");
  EXPECT_THAT(imported.said,
              HasSubstr("given:5:27: warning: the exception that 'HR1' answers with is not carried over"));
}

TEST(UnslaveImport, Every_slave_is_a_map_of_its_own) {
  const std::string text =
      R"({"mode": "TCP", "slaves": {"1": {"isOnline": true, "registers": {"IR1": 7}}, "20": {"isOnline": false, "registers": {"DI3": false}}}})";
  const Imported both("unslave", text, {"sim", {}});
  ASSERT_EQ(both.result.maps.size(), 2U);
  EXPECT_EQ(both.text(1), "name: sim_20\nunit: 20\nmapping:\n  discrete_inputs:\n    di_3: 3\n");
  EXPECT_THAT(both.said, HasSubstr("'isOnline' is not carried over"));
  EXPECT_EQ(Imported("unslave", text, {"sim", 20}).text(), both.text(1));
}

TEST(UnslaveImport, What_is_no_register_and_what_is_there_twice_is_told) {
  const Imported imported("unslave", R"({"mode": "TCP", "slaves": {"1": {"isOnline": true, "registers": {
    "HR1": 1, "hr01": 2, "XR5": 3, "HR": 1, "HR2": -5}}}})");
  EXPECT_THAT(imported.said, HasSubstr("given:2:15: warning: 'hr01' is given twice"));
  EXPECT_THAT(imported.said, HasSubstr("'XR5' is not a register"));
  EXPECT_THAT(imported.said, HasSubstr("'HR' is not a register"));
  EXPECT_THAT(imported.text(), HasSubstr("hr_2: {address: 2, type: UINT, initial: 65531}"));
}

TEST(UnslaveImport, Wrong_files_are_refused_where_they_are_wrong) {
  EXPECT_THAT(Imported("unslave", "{\"slaves\": {\"1\": {\"registers\": {\"HR0\": 1").said,
              HasSubstr("given:1:"));
  EXPECT_THAT(Imported("unslave", "{\"name\": \"a\", \"mapping\": {}}").said,
              HasSubstr("error: there are no 'slaves' in the file"));
  EXPECT_THAT(Imported("unslave", "{\"slaves\": {\"300\": {}}}").said,
              HasSubstr("given:1:13: error: '300' is not a unit id"));
  EXPECT_THAT(Imported("unslave", R"({"slaves": {"1": {"registers": {"HR70000": 1}}}})").said,
              HasSubstr("error: "));
  EXPECT_THAT(Imported("unslave", R"({"slaves": {"1": {"registers": {"HR7": 65536}}}})").said,
              HasSubstr("error: the value of 'HR7' is '65536', not a number from -32768 to 65535"));
  EXPECT_THAT(Imported("unslave", R"({"slaves": {"1": {}, "01": {}}})").said,
              HasSubstr("error: unit 1 is there twice"));
}

}  // namespace
}  // namespace coupler::test
