// SPDX-License-Identifier: Apache-2.0
// The whole of the driver's core on a real socket.
#include <gtest/gtest.h>

#include <thread>

#include "coupler/host/core/device_thread.hpp"
#include "coupler/host/core/write.hpp"
#include "coupler/host/modbus/make_links.hpp"
#include "test/fakes/map_builder.hpp"
#include "test/host/modbus/listeners.hpp"
#include "test/host/modbus/modbus_server.hpp"

namespace coupler::host {
namespace {

using WriteOutcome = WriteResult::Outcome;

struct WriteStorm : testing::Test {
  MapPtr make_map() const {
    fakes::MapBuilder builder;
    builder.many(Table::coils, 0, 32).many(Table::holding_registers, 0, 32);
    builder.head().connection.address = "localhost";
    builder.head().connection.port = server.port();
    builder.head().connection.timeout = std::chrono::seconds(20);
    builder.head().polling.rate = 500;
    return builder.build();
  }
  /// Returns once a write has come through.
  static void wait_until_connected(DeviceThread& device) {
    for (;;) {
      WriteTicket ticket;
      Write write;
      write.listener = &ticket;
      device.write(write);
      if (ticket.wait().outcome == WriteOutcome::ok) return;
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
  }
  static void write(DeviceThread& device, std::uint32_t point, std::uint16_t value, WriteListener* listener) {
    Write write;
    write.point = point;
    write.registers[0] = value;
    write.listener = listener;
    device.write(write);
  }
  test::ModbusServer server;
  MapPtr owned = make_map();
  Link link = make_link(owned->map().connection);
  ValueTable values{owned->map()};
  DeafSink sink;
};

TEST_F(WriteStorm, Every_write_has_one_result_while_many_threads_write_and_connections_break) {
  constexpr int threads = 4;
  constexpr int writes = 2000;
  server.hang_up_after = 301;
  Tally tally;
  std::atomic<int> written{0};
  {
    DeviceThread device(owned->map(), Verify::off, {}, link, values, sink);
    device.start();
    wait_until_connected(device);
    std::vector<std::thread> writers;
    writers.reserve(threads);
    for (int t = 0; t < threads; ++t)
      writers.emplace_back([&, t] {
        for (int i = 0; i < writes || tally.ok == 0; ++i) {
          Write write;
          write.point = static_cast<std::uint32_t>((t * 16 + i) % 64);
          write.registers[0] = static_cast<std::uint16_t>(i % 2);
          write.listener = &tally;
          device.write(write);
          ++written;
          if (i % 50 == 0) {
            device.statistics();
            values.qualities(std::chrono::steady_clock::now());
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
          }
        }
      });
    for (std::thread& writer : writers) writer.join();
  }
  EXPECT_EQ(tally.all, written);
  EXPECT_GT(tally.ok, 0);
}

TEST_F(WriteStorm, What_was_written_last_stands_in_the_device) {
  {
    DeviceThread device(owned->map(), Verify::off, {}, link, values, sink);
    device.start();
    wait_until_connected(device);
    for (std::uint16_t value = 1; value < 100; ++value)
      for (std::uint32_t point = 32; point < 40; ++point) write(device, point, value, nullptr);
    for (std::uint32_t point = 32; point < 40; ++point) {
      WriteTicket ticket;
      write(device, point, 100, &ticket);
      EXPECT_EQ(ticket.wait().outcome, WriteOutcome::ok);
    }
    EXPECT_GT(device.statistics().written(WriteOutcome::ok), 0U);
  }
  for (int address = 0; address < 8; ++address) EXPECT_EQ(server.tables().tab_registers[address], 100);
}

}  // namespace
}  // namespace coupler::host
