// SPDX-License-Identifier: Apache-2.0
#include "coupler/map/node_address.hpp"

#include <gmock/gmock.h>

namespace coupler {
namespace {

using ::testing::HasSubstr;

TEST(NodeAddress, A_host_alone_has_the_default_port_and_unit) {
  const auto node = parse_node_address("tcp://cell.example");
  ASSERT_TRUE(node) << node.error().what;
  EXPECT_EQ(node->host, "cell.example");
  EXPECT_EQ(node->port, 502);
  EXPECT_EQ(node->unit, 1);
}

TEST(NodeAddress, Port_and_unit_are_read) {
  const auto node = parse_node_address("tcp://10.0.0.7:1502/247");
  ASSERT_TRUE(node) << node.error().what;
  EXPECT_EQ(node->host, "10.0.0.7");
  EXPECT_EQ(node->port, 1502);
  EXPECT_EQ(node->unit, 247);
}

TEST(NodeAddress, An_ipv6_address_stands_in_brackets) {
  const auto node = parse_node_address("tcp://[fe80::1]:1502/3");
  ASSERT_TRUE(node) << node.error().what;
  EXPECT_EQ(node->host, "fe80::1");
  EXPECT_EQ(node->port, 1502);
  EXPECT_EQ(parse_node_address("tcp://[::1]")->host, "::1");
  EXPECT_THAT(parse_node_address("tcp://fe80::1").error().what, HasSubstr("in brackets"));
}

TEST(NodeAddress, A_slash_at_the_end_is_no_unit) { EXPECT_EQ(parse_node_address("tcp://cell/")->unit, 1); }

TEST(NodeAddress, What_is_not_given_can_be_that_of_a_map) {
  Connection map;
  map.port = 1502;
  map.unit = 7;
  EXPECT_EQ(parse_node_address("tcp://cell", map)->port, 1502);
  EXPECT_EQ(parse_node_address("tcp://cell", map)->unit, 7);
  EXPECT_EQ(parse_node_address("tcp://cell:503/2", map)->port, 503);
  EXPECT_EQ(parse_node_address("tcp://cell:503/2", map)->unit, 2);
}

TEST(NodeAddress, A_connection_as_text_reads_back_the_same) {
  for (const std::string_view text : {"tcp://cell:1502/3", "tcp://[fe80::1]:502/0"}) {
    const auto node = parse_node_address(text);
    ASSERT_TRUE(node) << node.error().what;
    EXPECT_EQ(node_address_text(found_at({}, *node).connection), text);
  }
}

TEST(NodeAddress, A_serial_port_has_settings) {
  const auto node =
      parse_node_address("rtu:/dev/serial/by-id/usb-FTDI/17?baud=9600&parity=none&stop_bits=2&rs485=true");
  ASSERT_TRUE(node) << node.error().what;
  EXPECT_EQ(node->serial, (Serial{"/dev/serial/by-id/usb-FTDI", 9600, Serial::Parity::none, 2, true}));
  EXPECT_EQ(node->unit, 17);
  EXPECT_EQ(node->host, "");
}

TEST(NodeAddress, A_serial_port_alone_has_the_default_settings) {
  const auto node = parse_node_address("rtu:/dev/ttyUSB0");
  ASSERT_TRUE(node) << node.error().what;
  EXPECT_EQ(node->serial, Serial{"/dev/ttyUSB0"});
  EXPECT_EQ(node->unit, 1);
  EXPECT_EQ(found_at({}, *node).connection.timeout, usual_timeout(true));
}

TEST(NodeAddress, The_number_of_a_pseudo_terminal_is_no_unit) {
  EXPECT_EQ(parse_node_address("rtu:/dev/pts/5")->serial.device, "/dev/pts/5");
  EXPECT_EQ(parse_node_address("rtu:/dev/pts/5")->unit, 1);
  EXPECT_EQ(parse_node_address("rtu:/dev/pts/5/6")->serial.device, "/dev/pts/5");
  EXPECT_EQ(parse_node_address("rtu:/dev/pts/5/6")->unit, 6);
}

TEST(NodeAddress, Settings_that_are_not_given_can_be_those_of_a_map) {
  Connection map;
  map.serial = {"/dev/ttyS0", 9600, Serial::Parity::odd, 1, false};
  EXPECT_EQ(parse_node_address("rtu:/dev/ttyUSB0?baud=19200", map)->serial,
            (Serial{"/dev/ttyUSB0", 19200, Serial::Parity::odd, 1, false}));
}

TEST(NodeAddress, Tls_has_a_port_of_its_own) {
  const auto node = parse_node_address("tls://press");
  ASSERT_TRUE(node) << node.error().what;
  EXPECT_TRUE(node->tls);
  EXPECT_EQ(node->port, 802);
  EXPECT_EQ(parse_node_address("tls://press:1802/3")->port, 1802);
  Connection map;
  map.port = 1802;
  EXPECT_EQ(parse_node_address("tls://press", map)->port, 802) << "that is the map's without TLS";
  map.tls.certificate = "cell1.pem";
  EXPECT_EQ(parse_node_address("tls://press", map)->port, 1802);
  EXPECT_FALSE(parse_node_address("tcp://press", map)->tls);
}

TEST(NodeAddress, What_is_left_out_before_a_host_is_as_the_map_has_it) {
  Connection map;
  EXPECT_EQ(node_argument("press", map), "tcp://press");
  map.tls.certificate = "cell1.pem";
  EXPECT_EQ(node_argument("press", map), "tls://press");
  EXPECT_EQ(node_argument("tcp://press", map), "tcp://press");
}

TEST(NodeAddress, A_map_found_without_TLS_has_none) {
  Map map;
  map.connection.tls.certificate = "cell1.pem";
  EXPECT_TRUE(found_at(map, *parse_node_address("tls://press")).connection.tls.present());
  EXPECT_FALSE(found_at(map, *parse_node_address("tcp://press")).connection.tls.present());
}

TEST(NodeAddress, Rtu_may_go_over_tcp) {
  const auto node = parse_node_address("rtu+tcp://cell:4001/3");
  ASSERT_TRUE(node) << node.error().what;
  EXPECT_EQ(node->framing, Framing::rtu);
  EXPECT_EQ(node->port, 4001);
  EXPECT_EQ(node_address_text(found_at({}, *node).connection), "rtu+tcp://cell:4001/3");
}

TEST(NodeAddress, A_path_is_a_serial_port_where_a_device_is_expected) {
  EXPECT_EQ(node_argument("/dev/ttyUSB0"), "rtu:/dev/ttyUSB0");
  EXPECT_EQ(node_argument("cell"), "tcp://cell");
  EXPECT_EQ(node_argument("rtu+tcp://cell"), "rtu+tcp://cell");
}

TEST(NodeAddress, What_is_wrong_of_a_serial_port_is_said_with_a_remedy) {
  const std::pair<const char*, const char*> cases[] = {
      {"rtu:", "there is no device"},
      {"rtu:/dev/ttyUSB0/0", "the unit id '0' is not 1 to 247"},
      {"rtu:/dev/ttyUSB0/248", "the unit id '248' is not 1 to 247"},
      {"rtu:/dev/ttyUSB0?baud=9601", "'baud=9601' is no setting"},
      {"rtu:/dev/ttyUSB0?baud", "'baud' is no setting"},
      {"rtu:/dev/ttyUSB0?parity=N", "'parity=N' is no setting"},
      {"rtu:/dev/ttyUSB0?stop_bits=3", "'stop_bits=3' is no setting"},
      {"rtu:/dev/ttyUSB0?rs485=yes", "'rs485=yes' is no setting"},
      {"rtu:/dev/ttyUSB0?speed=9600", "'speed=9600' is no setting"},
  };
  for (const auto& [argument, what] : cases) {
    const auto node = parse_node_address(argument);
    ASSERT_FALSE(node) << argument;
    EXPECT_THAT(node.error().what, HasSubstr(what));
    EXPECT_THAT(node.error().remedy, HasSubstr("write rtu:DEVICE[/UNIT]"));
  }
}

TEST(NodeAddress, What_is_wrong_is_said_with_a_remedy) {
  const std::pair<const char*, const char*> cases[] = {
      {"tcp://", "there is no host"},       {"tcp://:502", "there is no host"},
      {"tcp://cell:0", "the port '0'"},     {"tcp://cell:65536", "the port '65536'"},
      {"tcp://cell:", "the port ''"},       {"tcp://cell/256", "the unit id '256'"},
      {"tcp://cell/x", "the unit id 'x'"},  {"tcp://[::1]502", "after ']'"},
      {"udp://cell", "begins with tcp://"}, {"tcp://cell:5 02", "the port '5 02'"},
  };
  for (const auto& [argument, what] : cases) {
    const auto node = parse_node_address(argument);
    ASSERT_FALSE(node) << argument;
    EXPECT_THAT(node.error().what, HasSubstr(what));
    EXPECT_THAT(node.error().remedy, HasSubstr("write tcp://HOST[:PORT][/UNIT]"));
  }
}

TEST(NodeAddress, A_serial_port_without_its_folder_is_no_host) {
  for (const char* argument : {"tcp://ttyUSB0", "tcp://ttyACM1/17", "rtu+tcp://ttyS0"}) {
    const auto node = parse_node_address(argument);
    ASSERT_FALSE(node) << argument;
    EXPECT_THAT(node.error().what, HasSubstr("is the name of a serial port"));
    EXPECT_THAT(node.error().remedy, HasSubstr("rtu:/dev/tty"));
  }
  EXPECT_TRUE(parse_node_address("tcp://tty-gateway"));
}

TEST(NodeAddress, Its_host_is_one_that_a_map_may_have) {
  const std::pair<const char*, const char*> cases[] = {
      {"tcp://192.168.1.300", "the host '192.168.1.300' is not an IP address"},
      {"tcp://192.168.1.300:502/1", "the host '192.168.1.300' is not an IP address"},
      {"tcp://cell/1/2", "the host 'cell/1' is not a host name"},
      {"tcp://ce ll", "the host 'ce ll' is not a host name"},
      {"tcp://[cell]", "the host '[cell]' is not a host name"},
      {"tcp://[fe80:::1]", "the host '[fe80:::1]' is not an IPv6 address"},
  };
  for (const auto& [argument, what] : cases) {
    const auto node = parse_node_address(argument);
    ASSERT_FALSE(node) << argument;
    EXPECT_EQ(node.error().what, what);
  }
  EXPECT_EQ(parse_node_address("tcp://192.168.1.300").error().remedy,
            "write four numbers from 0 to 255, as in 192.168.0.10");
  EXPECT_EQ(parse_node_address("tcp://[fe80::7%eth0]:502")->host, "fe80::7%eth0");
}

}  // namespace
}  // namespace coupler
