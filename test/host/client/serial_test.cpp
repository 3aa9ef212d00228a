// SPDX-License-Identifier: Apache-2.0
// A generated client, config/examples/pump, of a unit on a serial line.
#include <gmock/gmock.h>

#include "pump_client.hpp"
#include "test/host/modbus/serial_line.hpp"

namespace coupler::client {
namespace {

using namespace std::chrono_literals;
using host::test::Octets;

/// Bits are 1, registers have 0 in all of their bytes; what is written is confirmed.
Octets answer(const Octets& request) {
  const std::size_t count = request[4] * 256U + request[5];
  const bool bits = request[1] <= 2;
  if (request[1] > 4) return host::test::rtu(request[0], {request.begin() + 1, request.begin() + 6});
  const std::size_t size = bits ? (count + 7) / 8 : 2 * count;
  Octets pdu{request[1], static_cast<std::uint8_t>(size)};
  pdu.resize(2 + size, bits ? 0xFF : 0);
  return host::test::rtu(request[0], pdu);
}

std::string said_of(const std::string& address) {
  std::string said;
  Options options;
  options.address = address;
  options.on_report = [&](Level, const std::string& text) { said = text; };
  const maps::pump::Client pump(options);
  return said;
}

TEST(ClientOnASerialLine, Reads_and_writes) {
  const host::test::SerialLine line(answer);
  Options options;
  options.address = "rtu:" + line.device() + "/17?baud=115200&parity=none";
  maps::pump::Client pump(options);
  pump.connect();
  EXPECT_EQ(pump.running.wait(20s)->value, true);
  EXPECT_DOUBLE_EQ(pump.pressure.wait(20s)->value, 0);
  EXPECT_TRUE(pump.valve.set(true).get());
}

TEST(ClientOnASerialLine, Is_told_what_is_wrong_with_its_address) {
  EXPECT_THAT(said_of("rtu:/dev/ttyUSB0/17?baud=9601"), ::testing::HasSubstr("baud=9601"));
  EXPECT_THAT(said_of("rtu:/dev/ttyUSB0/248"), ::testing::HasSubstr("1 to 247"));
}

}  // namespace
}  // namespace coupler::client
