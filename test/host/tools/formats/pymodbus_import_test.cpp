// SPDX-License-Identifier: Apache-2.0
// The format is that of pymodbus' documentation ("Simulator", ModbusSimulatorContext). That its simulator
// serves what the map reads is proved by test/simulator.
#include <gmock/gmock.h>

#include "test/host/tools/formats/imported.hpp"

namespace coupler::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

/// A device alone. `sizes` is of all four tables, in registers.
std::string device(const std::string& parts, bool shared = true, int size = 100,
                   const std::string& defaults = "") {
  const std::string n = std::to_string(size);
  return R"({"setup": {"co size": )" + n + R"(, "di size": )" + n + R"(, "ir size": )" + n +
         R"(, "hr size": )" + n + R"(, "shared blocks": )" + (shared ? "true" : "false") +
         R"(, "type exception": false, "defaults": {"value": {"bits": 0, "uint16": 0, "uint32": 0, "float32": 0.0, "string": " "},
         "action": {"bits": null, "uint16": null, "uint32": null, "float32": null, "string": null}}})" +
         defaults + ", " + parts + "}";
}

TEST(PymodbusImport, In_shared_blocks_bits_are_bits_and_all_else_holding_registers) {
  const Imported imported("pymodbus", device(R"("invalid": [1], "write": [2, [10, 13]],
      "bits": [{"addr": 2, "value": 5}, 3], "uint16": [[10, 11]], "uint32": [{"addr": [12, 13], "value": 617001}, [14, 17]],
      "float32": [{"addr": [20, 21], "value": 404.17}], "string": [{"addr": [30, 32], "value": "pump"}], "repeat": [])"));
  EXPECT_EQ(imported.text(),
            "name: given\nwordorder_reverse: true\nmapping:\n  coils:\n"
            "    bits_32: {address: 32, count: 16, initial: [on, off, on, off, off, off, off, off, off, off, "
            "off, off, off, "
            "off, off, off]}\n"
            "  discrete_inputs:\n    bits_48: {address: 48, count: 16}\n"
            "  holding_registers:\n    uint16_10: {address: 10, type: UINT, count: 2}\n"
            "    uint32_12: {address: 12, type: UDINT, initial: 617001}\n"
            "    uint32_14: {address: 14, type: UDINT, count: 2, access: read}\n"
            "    float32_20: {address: 20, type: REAL, initial: 404.17, access: read}\n"
            "    string_30: {address: 30, type: STRING, length: 6, order: AB, initial: pump, "
            "access: read}\n");
  EXPECT_THAT(imported.said,
              AllOf(HasSubstr("the simulator has no names"), HasSubstr("every table shows every register")));
}

TEST(PymodbusImport,
     Blocks_of_their_own_follow_each_other_coils_discrete_inputs_input_and_holding_registers) {
  const Imported imported(
      "pymodbus",
      device(R"("invalid": [], "write": [[0, 0], [31, 32]], "bits": [{"addr": 0, "value": 1}, 12, 22],
      "uint16": [{"addr": 13, "value": 2}, 23, 31], "uint32": [[24, 25]], "float32": [[32, 33]], "string": [], "repeat": [])",
             false, 10));
  EXPECT_EQ(
      imported.text(),
      "name: given\nwordorder_reverse: true\nmapping:\n  coils:\n"
      "    co_bits_0: {address: 0, count: 16, initial: [on, off, off, off, off, off, off, off, off, off, "
      "off, "
      "off, off, "
      "off, off, off]}\n"
      "  discrete_inputs:\n    di_bits_32: {address: 32, count: 16}\n"
      "    di_uint16_48: {address: 48, count: 16, initial: [off, on, off, off, off, off, off, off, off, off, "
      "off, off, "
      "off, off, off, off]}\n"
      "  input_registers:\n    ir_bits_2: {address: 2, type: WORD}\n    ir_uint16_3: {address: 3, type: "
      "UINT}\n"
      "    ir_uint32_4: {address: 4, type: UDINT}\n"
      "  holding_registers:\n    hr_uint16_1: {address: 1, type: UINT}\n"
      "    hr_float32_2: {address: 2, type: REAL, access: read}\n");
}

TEST(PymodbusImport, A_value_that_the_file_does_not_say_is_none) {
  EXPECT_EQ(Imported("pymodbus",
                     R"({"setup": {"co size": 9, "di size": 9, "ir size": 9, "hr size": 9}, "uint16": [30]})")
                .text(),
            "name: given\nwordorder_reverse: true\nmapping:\n  holding_registers:\n"
            "    hr_uint16_3: {address: 3, type: UINT, access: read}\n");
}

TEST(PymodbusImport, Bits_that_no_request_for_bits_reaches_are_a_register) {
  const std::string text =
      Imported("pymodbus",
               device(R"("write": [4095, 4096], "bits": [4095, {"addr": 4096, "value": 5}])", true, 5000))
          .text();
  EXPECT_THAT(text,
              AllOf(HasSubstr("coils:\n    bits_65520: {address: 65520, count: 16}"),
                    HasSubstr("holding_registers:\n    bits_4096: {address: 4096, type: WORD, initial: 5}")));
}

TEST(PymodbusImport, A_value_may_be_written_if_all_its_registers_may) {
  EXPECT_THAT(
      Imported("pymodbus", device(R"("write": [4, 6, 7], "uint32": [[4, 7]])")).text(),
      HasSubstr(
          "uint32_4: {address: 4, type: UDINT, access: read}\n    uint32_6: {address: 6, type: UDINT}\n"));
}

TEST(PymodbusImport, A_repetition_copies_registers_with_their_values_until_its_end) {
  EXPECT_THAT(Imported("pymodbus", device(R"("write": [1], "uint16": [{"addr": 1, "value": 7}, 2],
          "repeat": [{"addr": [1, 2], "to": [10, 12]}])"))
                  .text(),
              AllOf(HasSubstr("uint16_10: {address: 10, type: UINT, initial: 7}\n    uint16_11: {address: "
                              "11, type: UINT, access: "
                              "read}\n    uint16_12: {address: 12, type: UINT, initial: 7}\n"),
                    Not(HasSubstr("uint16_13"))));
  const Imported cut("pymodbus",
                     device(R"("uint32": [[2, 3]], "repeat": [{"addr": [2, 3], "to": [10, 12]}])"));
  EXPECT_THAT(cut.text(), HasSubstr("uint32_10: {address: 10, type: UDINT, access: read}\n"));
  EXPECT_THAT(cut.said, HasSubstr("register 12 is a part of a value, so it is left out"));
}

TEST(PymodbusImport, An_array_is_no_longer_than_one_request) {
  const std::string text = Imported("pymodbus", device(R"("uint16": [[0, 199]])", true, 200)).text();
  EXPECT_THAT(text, AllOf(HasSubstr("uint16_0: {address: 0, type: UINT, count: 123, access: read}"),
                          HasSubstr("uint16_123: {address: 123, type: UINT, count: 77, access: read}")));
}

TEST(PymodbusImport, The_server_says_where_the_device_is) {
  const std::string servers = R"("server_list": {"server": {"comm": "tcp", "host": "10.0.0.7", "port": 5020,
    "framer": "socket", "device_id": 9, "identity": {"VendorName": "x"}}, "other": {"comm": "serial", "port": "/dev/tty0"}})";
  const Imported imported(
      "pymodbus", "{" + servers + R"(, "device_list": {"device": )" + device(R"("uint16": [1])") + "}}");
  EXPECT_THAT(imported.text(), HasSubstr("address: 10.0.0.7\nport: 5020\nunit: 9\n"));
  EXPECT_THAT(imported.said, HasSubstr("what only the simulator uses is not carried over: identity;"));
  const Imported any(
      "pymodbus",
      R"({"server_list": {"s": {"comm": "udp", "host": "0.0.0.0", "port": 5020}}, "device_list": {"d": )" +
          device(R"("uint16": [1])") + "}}");
  EXPECT_THAT(any.text(), Not(HasSubstr("address: 0.0.0.0")));
  EXPECT_THAT(any.said, HasSubstr("'udp' is Modbus over UDP, so the map has TCP in its place"));
}

TEST(PymodbusImport, One_of_several_devices_is_chosen_by_its_name) {
  const std::string text = R"({"device_list": {"a": )" + device(R"("uint16": [1])") + R"(, "b": )" +
                           device(R"("uint16": [2])") + "}}";
  EXPECT_THAT(Imported("pymodbus", text).said,
              HasSubstr("error: the file has several devices: a, b; give one of them with --device: a, b"));
  formats::ImportOptions options;
  options.device = "b";
  EXPECT_THAT(Imported("pymodbus", text, options).text(), HasSubstr("uint16_2"));
}

TEST(PymodbusImport, What_changes_by_itself_and_what_is_unknown_is_told) {
  const Imported imported(
      "pymodbus",
      device(
          R"("uint16": [{"addr": 1, "action": "increment", "parameters": {"minval": 1}}, {"addr": 2, "note": 1}],
      "float32": [{"addr": [4, 5], "action": null}])"));
  EXPECT_THAT(imported.said, AllOf(HasSubstr("the action 'increment' is not carried over"),
                                   HasSubstr("'note' is not carried over: the simulator ignores it, too"),
                                   Not(HasSubstr("float32,"))));
}

TEST(PymodbusImport, Wrong_files_are_refused_where_they_are_wrong) {
  EXPECT_THAT(Imported("pymodbus", "{}").said, HasSubstr("error: there are no devices in the file"));
  const std::pair<const char*, const char*> all[] = {
      {R"("uint16": [100])", "this is not a register below 100"},
      {R"("uint16": [[3, 2]])", "this is not a register below 100"},
      {R"("uint16": [{"value": 1}])", "there is no 'addr'"},
      {R"("uint32": [[2, 4]])", "3 registers are not whole values of uint32; give each value 2 registers"},
      {R"("uint16": [2], "bits": [2])", "register 2 is defined twice"},
      {R"("uint16": [2], "write": [3])", "register 3 may be written, but is not defined"},
      {R"("uint16": [2], "repeat": [{"addr": [1, 2]}])", "a repetition without 'addr' or 'to'"},
      {R"("uint16": [2], "float16": [3])", "'float16' is not a part of a device of the simulator"},
      {R"("uint16": [{"addr": 2, "value": 70000}])", "70000"},
  };
  for (const auto& [parts, what] : all) {
    const Imported imported("pymodbus", device(parts));
    EXPECT_THAT(imported.said, AllOf(HasSubstr("error: "), HasSubstr(what))) << parts;
  }
  EXPECT_THAT(Imported("pymodbus", R"({"setup": {"co size": 1}})").said,
              HasSubstr("error: 'di size' is not a number of registers from 0 to 65536"));
}

}  // namespace
}  // namespace coupler::test
