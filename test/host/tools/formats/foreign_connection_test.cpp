// SPDX-License-Identifier: Apache-2.0
// How importers read a serial line and what else carries frames to a device. The words and defaults are those
// of homeassistant/components/modbus (SERIAL_SCHEMA), pymodbus' ModbusSerialServer and its simulator's
// setup.json, the Unslave User Manual, and ModbusPalProject (saveSerialLinkParameters,
// loadSerialLinkParameters).
#include <gmock/gmock.h>

#include "test/host/tools/formats/imported.hpp"

namespace coupler::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

const std::string foreign_hub_sensors = "  sensors: [{name: s, slave: 2, address: 15, input_type: input}]\n";

/// A hub with these lines.
Imported foreign_hub(const std::string& lines) {
  return Imported("home-assistant", "- name: h\n" + lines + foreign_hub_sensors);
}

Imported pymodbus_server(const std::string& server) {
  return Imported("pymodbus",
                  "{\"server_list\": {\"server\": {" + server +
                      "}},\n \"device_list\": {\"device\": {\"setup\": {\"co size\": 10, \"di size\": 10, "
                      "\"hr size\": 10, \"ir size\": 10, \"shared blocks\": true}, \"uint16\": [3]}}}");
}

Imported unslave_file(const std::string& keys) {
  return Imported("unslave",
                  "{" + keys + "\n\"slaves\": {\"2\": {\"isOnline\": true, \"registers\": {\"HR0\": 1}}}}");
}

Imported modbuspal_links(const std::string& links) {
  return Imported("modbuspal", "<modbuspal_project>\n" + links +
                                   "\n<slave id=\"2\"><holding_registers><register address=\"0\" "
                                   "value=\"5\"/></holding_registers></slave></modbuspal_project>");
}

TEST(ForeignConnection, A_serial_hub_of_home_assistant_is_a_serial_map) {
  const Imported imported(
      "home-assistant",
      "---  # a list of hubs in a file of its own\n- name: inverter\n  type: serial\n  baudrate: 9600\n  "
      "bytesize: 8\n"
      "  method: rtu\n  parity: N\n  port: /dev/ttyUSB0\n  stopbits: 1\n  sensors:\n"
      "    - {name: voltage, slave: 247, address: 11000, data_type: int16, input_type: input}\n");
  EXPECT_EQ(imported.text(),
            "name: inverter\nunit: 247\ntimeout: 3\nrate: 0.06667\n"
            "serial: {device: /dev/ttyUSB0, baud: 9600, parity: none, stop_bits: 1}\n"
            "mapping:\n  input_registers:\n    voltage: {address: 11000, type: INT}\n");
  EXPECT_EQ(imported.said, "");
}

TEST(ForeignConnection, Rtu_over_tcp_keeps_its_framing) {
  const Imported imported = foreign_hub("  type: rtuovertcp\n  host: 10.0.0.7\n  port: 4196\n");
  EXPECT_THAT(imported.text(),
              AllOf(HasSubstr("address: 10.0.0.7\nport: 4196\nunit: 2\n"), HasSubstr("framing: rtu\n")));
  EXPECT_EQ(imported.said, "");
  EXPECT_THAT(pymodbus_server(R"("comm": "tcp", "host": "0.0.0.0", "port": 5020, "framer": "rtu")").text(),
              HasSubstr("port: 5020\nwordorder_reverse: true\nframing: rtu\n"));
  EXPECT_THAT(pymodbus_server(R"("comm": "tcp", "host": "0.0.0.0", "port": 5020, "framer": "rtu")").said,
              Not(HasSubstr("framer")));
  EXPECT_THAT(unslave_file(R"("mode": "RTU_OVER_TCP", "tcpPort": 4001,)").text(),
              HasSubstr("port: 4001\nunit: 2\nframing: rtu\n"));
  EXPECT_THAT(unslave_file(R"("mode": "TCP", "tcpPort": 4001, "port": {"name": "COM1"},)").text(),
              AllOf(HasSubstr("port: 4001\n"), Not(HasSubstr("framing")), Not(HasSubstr("serial"))));
}

TEST(ForeignConnection, What_a_map_does_not_have_is_told_where_it_stands) {
  const Imported imported = foreign_hub(
      "  type: serial\n  method: ascii\n  port: COM3\n  baudrate: 250000\n  bytesize: 7\n  parity: M\n  "
      "stopbits: 1.5\n");
  EXPECT_THAT(imported.text(),
              HasSubstr("serial: {device: COM3, baud: 19200, parity: even, stop_bits: 2}\n"));
  for (const char* said :
       {"given:3:11: warning: a map does not have the framing 'ascii' on a serial line, so it has RTU",
        "given:4:9: warning: 'COM3' is not a device file of Linux; write the port's device file into the map",
        "given:5:13: warning: a map cannot have '250000' as 'baud', so it has 19200; set the device to one "
        "of 110, ",
        "given:6:13: warning: 'bytesize' is '7', but RTU has 8 bits in a character; set the device to RTU "
        "with 8 bits",
        "given:7:11: warning: a map cannot have 'M' as 'parity', so it has even",
        "given:8:13: warning: a map cannot have '1.5' as 'stop_bits', so it has 2"})
    EXPECT_THAT(imported.said, HasSubstr(said));
}

TEST(ForeignConnection, Keys_that_the_file_lacks_are_told_where_the_program_demands_them) {
  const Imported imported = foreign_hub("  type: serial\n  port: socket://10.0.0.7:4196\n  parity: O\n");
  EXPECT_THAT(imported.text(), HasSubstr("baud: 19200, parity: odd, stop_bits: 1}\n"));
  EXPECT_THAT(
      imported.said,
      AllOf(
          HasSubstr("given:1:3: warning: there is no 'baudrate', so the map has 19200; write what the device "
                    "is set to"),
          HasSubstr("there is no 'stopbits', so the map has 1"), Not(HasSubstr("no 'parity'")),
          HasSubstr("given:3:9: warning: 'socket://10.0.0.7:4196' is a serial port behind a network address; "
                    "write 'address', "
                    "'port' and 'framing: rtu'")));
  EXPECT_THAT(
      foreign_hub("  type: serial\n  port: !secret port\n  baudrate: 9600\n  parity: E\n  stopbits: 1\n")
          .text(),
      HasSubstr("serial: {device: /dev/ttyUSB0, baud: 9600, parity: even, stop_bits: 1}\n"));
  EXPECT_THAT(unslave_file(R"("mode": "RTU", "serial": {"port": "/dev/ttyS1"},)").said,
              HasSubstr("there is no 'baudRate', so the map has 19200"));
  EXPECT_THAT(foreign_hub("  type: serial\n  host: 10.0.0.7\n").said,
              HasSubstr("given:3:9: error: a hub on a serial line has no 'host'; write 'type: rtuovertcp'"));
}

TEST(ForeignConnection, Udp_tls_and_unknown_words_are_told) {
  EXPECT_THAT(
      foreign_hub("  type: udp\n  host: plc\n  port: 502\n").said,
      HasSubstr("given:2:9: warning: 'udp' is Modbus over UDP, so the map has TCP in its place; check that"));
  EXPECT_THAT(foreign_hub("  type: rtuoverudp\n  host: plc\n  port: 502\n").text(),
              HasSubstr("framing: rtu\n"));
  EXPECT_THAT(foreign_hub("  type: zigbee\n  host: plc\n  port: 502\n").said,
              HasSubstr("given:2:9: warning: 'zigbee' is not known, so the map has Modbus/TCP"));
  EXPECT_THAT(pymodbus_server(R"("comm": "tls", "host": "plc", "port": 802, "framer": "tls")").said,
              HasSubstr("the certificates of TLS are not carried over, so the map has none; add 'tls' with"));
  EXPECT_THAT(pymodbus_server(R"("comm": "tcp", "host": "plc", "port": 802, "framer": "binary")").said,
              HasSubstr("a map does not have the framing 'binary', so it has RTU; set the device to RTU"));
  EXPECT_THAT(unslave_file(R"("mode": "ASCII", "serial": {"port": "/dev/ttyS1"},)").said,
              HasSubstr("given:1:10: warning: 'ASCII' is Modbus ASCII, so the map has RTU in its place"));
}

TEST(ForeignConnection, A_framer_has_many_names) {
  const auto with = [](const std::string& framer) {
    return pymodbus_server(R"("comm": "tcp", "host": "plc", "port": 802, )" + framer);
  };
  for (const char* word : {"ModbusSocketFramer", "FramerType.SOCKET", "socket", "SOCKET", "", "default"}) {
    const Imported imported = with(R"("framer": ")" + std::string(word) + "\"");
    EXPECT_THAT(imported.text(), Not(HasSubstr("framing"))) << word;
    EXPECT_THAT(imported.said, Not(HasSubstr("framing"))) << word;
  }
  for (const char* key :
       {R"("framer": "ModbusRtuFramer")", R"("framer": "FramerType.RTU")", R"("method": "rtu")"}) {
    EXPECT_THAT(with(key).text(), HasSubstr("framing: rtu")) << key;
    EXPECT_THAT(with(key).said, Not(HasSubstr("framing"))) << key;
  }
  EXPECT_THAT(with(R"("framer": "carrier pigeon")").text(), Not(HasSubstr("framing")));
  EXPECT_THAT(
      with(R"("framer": "carrier pigeon")").said,
      HasSubstr("warning: the framing 'carrier pigeon' is not known, so the map has Modbus/TCP; write "
                "'framing: rtu' into the map if the device speaks RTU over TCP"));
}

TEST(ForeignConnection, Unslaves_tcp_port_alone_is_TCP) {
  EXPECT_THAT(unslave_file(R"("tcpPort": 4001,)").text(),
              AllOf(HasSubstr("port: 4001\n"), Not(HasSubstr("serial"))));
}

TEST(ForeignConnection, A_unit_that_rtu_does_not_have_is_refused_where_it_stands) {
  EXPECT_THAT(Imported("home-assistant",
                       "- type: rtuovertcp\n  host: plc\n  sensors: [{name: s, address: 1, slave: 255}]\n")
                  .said,
              HasSubstr("given:3:42: error: 'unit': 255 is reserved on a serial line"));
  EXPECT_THAT(pymodbus_server(R"("comm": "serial", "port": "/dev/ttyS0", "device_id": 250)").said,
              HasSubstr("given:1:82: error: 'unit': 250 is reserved on a serial line"));
}

TEST(ForeignConnection, A_serial_server_of_pymodbus_has_its_defaults) {
  EXPECT_THAT(
      pymodbus_server(R"("comm": "serial", "port": "/dev/ttyS0", "stopbits": 2, "bytesize": 8, "parity": "E",
    "baudrate": 9600, "framer": "rtu")")
          .text(),
      HasSubstr("serial: {device: /dev/ttyS0, baud: 9600, parity: even, stop_bits: 2}\n"));
  const Imported bare = pymodbus_server(R"("comm": "serial", "port": "/dev/ttyS0", "framer": null)");
  EXPECT_THAT(bare.text(),
              HasSubstr("serial: {device: /dev/ttyS0, baud: 19200, parity: none, stop_bits: 1}\n"));
  EXPECT_THAT(bare.said, AllOf(Not(HasSubstr("baud")), Not(HasSubstr("framer"))));
  EXPECT_THAT(
      pymodbus_server(R"("comm": "tcp", "port": "x", "device_id": 256)").said,
      AllOf(HasSubstr("given:1:52: error: 'port'"), HasSubstr("'256' is not a unit id, so it is left out")));
  EXPECT_THAT(pymodbus_server(R"("comm": "serial", "host": "plc", "framer": "socket")").said,
              AllOf(HasSubstr("the file does not name the serial port, so the map has /dev/ttyUSB0"),
                    HasSubstr("a map does not have the framing 'socket' on a serial line")));
}

TEST(ForeignConnection, Unslaves_line_stands_in_a_section_or_beside_its_port) {
  for (
      const char* keys :
      {R"("mode": "RTU", "serial": {"port": "/dev/ttyS1", "baudRate": 9600, "parity": "none", "stopBits": 1},)",
       R"("port": {"name": "/dev/ttyS1", "baudRate": 9600, "parity": "None", "stopBits": "One", "dataBits": 8},)",
       R"("port": "/dev/ttyS1", "baudRate": 9600, "parity": "none", "stopBits": 1, "tcpPort": 502,)"}) {
    const Imported imported = unslave_file(keys);
    EXPECT_THAT(imported.text(),
                AllOf(HasSubstr("serial: {device: /dev/ttyS1, baud: 9600, parity: none, stop_bits: 1}\n"),
                      Not(HasSubstr("port: 502"))));
    EXPECT_THAT(imported.said, Not(HasSubstr("not carried over"))) << keys;
  }
}

TEST(ForeignConnection, Modbuspals_selected_link_is_the_maps) {
  const std::string serial =
      "<tcpip port=\"502\"/>\n<serial com=\"COM1\" baudrate=\"9600\" parity=\"2\" stops=\"1\">"
      "<flowcontrol xonxoff=\"false\" rtscts=\"true\"/></serial></links>";
  const Imported imported = modbuspal_links("<links selected=\"Serial\">" + serial);
  EXPECT_THAT(imported.text(),
              AllOf(HasSubstr("serial: {device: COM1, baud: 9600, parity: even, stop_bits: 1}\n"),
                    Not(HasSubstr("port: 502"))));
  EXPECT_THAT(
      imported.said,
      AllOf(HasSubstr("given:3:9: warning: 'COM1' is not a device file of Linux"),
            HasSubstr("given:3:86: warning: the flow control 'rtscts' is not carried over: RTU has none")));
  EXPECT_THAT(modbuspal_links("<links selected=\"TCP/IP\">" + serial).text(),
              HasSubstr("port: 502\nunit: 2\nmapping"));
}

TEST(ForeignConnection, Modbuspals_numbers_and_defaults_are_its_own) {
  const auto line = [](const std::string& attributes) {
    return modbuspal_links("<links selected=\"Serial\"><serial com=\"/dev/ttyS0\"" + attributes +
                           "/></links>");
  };
  EXPECT_THAT(line("").text(), HasSubstr("baud: 9600, parity: even, stop_bits: 1}\n"));
  EXPECT_THAT(line(" parity=\"0\" stops=\"2\"").text(), HasSubstr("parity: none, stop_bits: 2}\n"));
  EXPECT_THAT(line(" parity=\"1\"").text(), HasSubstr("parity: odd,"));
  EXPECT_THAT(line(" parity=\"odd\"").text(), HasSubstr("parity: odd,"));
  EXPECT_THAT(line(" stops=\"3\"").said,
              HasSubstr("given:2:51: warning: a map cannot have '3' as 'stop_bits', so it has 2"));
  EXPECT_THAT(line(" parity=\"3\"").said, HasSubstr("a map cannot have '3' as 'parity', so it has even"));
  EXPECT_THAT(modbuspal_links("<links selected=\"Serial\"/>").text(),
              HasSubstr("serial: {device: /dev/ttyUSB0, baud: 9600,"));
}

}  // namespace
}  // namespace coupler::test
