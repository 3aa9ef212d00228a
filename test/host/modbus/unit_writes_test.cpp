// SPDX-License-Identifier: Apache-2.0
// Devices that write to units behind a gateway, each in its thread.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <deque>
#include <future>
#include <thread>
#include <vector>

#include "coupler/host/core/device_thread.hpp"
#include "coupler/host/core/write.hpp"
#include "test/host/modbus/listeners.hpp"
#include "test/host/modbus/units_behind_gateway.hpp"

namespace coupler::host {
namespace {

using std::chrono::milliseconds;

TEST_F(SharedChannelTest, A_write_waits_for_the_request_in_flight_and_for_no_other_read) {
  constexpr int writes = 20;
  make();
  DeafSink sink;
  std::deque<ValueTable> values;
  std::deque<DeviceThread> devices;
  for (std::size_t i = 0; i < units; ++i)
    devices.emplace_back(owned[i]->map(), Verify::off, MapLoader(), *links[i],
                         values.emplace_back(owned[i]->map()), sink);
  for (DeviceThread& device : devices) device.start();
  while (gateway.reads < 10 * units) std::this_thread::sleep_for(milliseconds(10));
  // A write of unit 1 while a read of unit 2 is in flight, which takes so long: its thread has to come
  // meanwhile.
  const auto is_overtaken = [&](milliseconds in_flight) {
    gateway.held = 2;
    while (!gateway.holds) std::this_thread::sleep_for(milliseconds(1));
    const int before = gateway.reads;
    WriteTicket ticket;
    Write write;
    write.listener = &ticket;
    devices[0].write(write);
    std::this_thread::sleep_for(in_flight);
    gateway.held = -1;
    EXPECT_EQ(ticket.wait().outcome, WriteResult::Outcome::ok);
    return gateway.reads_before_write > before;
  };
  for (int i = 0; i < writes; ++i)
    ASSERT_FALSE(is_overtaken(milliseconds(10)) && is_overtaken(milliseconds(200)) &&
                 is_overtaken(milliseconds(2000)));
}

TEST_F(SharedChannelTest, At_the_end_a_unit_that_is_silent_keeps_no_other_from_its_safe_values) {
  on_shutdown = OnShutdown::safe;
  const auto is_made_safe = [this] {
    make();
    OnlineSink sink;
    DeafSink deaf;
    ValueTable values(owned[0]->map());
    DeviceThread healthy(owned[0]->map(), Verify::off, MapLoader(), unit(1), values, sink);
    healthy.start();
    while (!sink.is_online) std::this_thread::sleep_for(milliseconds(1));
    gateway.silent = 2;
    const int unanswered = gateway.unanswered;
    ValueTable none(owned[1]->map());
    DeviceThread silent(owned[1]->map(), Verify::require, MapLoader(), unit(2), none, deaf);
    silent.start();
    while (gateway.unanswered == unanswered)
      std::this_thread::sleep_for(milliseconds(1));  // for its identity, 20 s long
    auto silent_ends = std::async(std::launch::async, [&] { return silent.end(); });
    const bool made_safe = healthy.end();
    EXPECT_FALSE(silent_ends.get());
    return made_safe && gateway.written == 1;
  };
  bool made_safe = false;
  for (int i = 0; i < 20 && !made_safe; ++i) made_safe = is_made_safe();  // a busy machine may be late
  EXPECT_TRUE(made_safe);
}

TEST_F(SharedChannelTest, Every_write_has_one_result_while_all_units_write_and_the_gateway_hangs_up) {
  constexpr int writes = 1000;
  gateway.ends_each = 301;
  make();
  DeafSink sink;
  Tally tally;
  std::atomic<int> written{0};
  {
    std::deque<ValueTable> values;
    std::deque<DeviceThread> devices;
    for (std::size_t i = 0; i < units; ++i)
      devices.emplace_back(owned[i]->map(), Verify::off, MapLoader(), *links[i],
                           values.emplace_back(owned[i]->map()), sink);
    for (DeviceThread& device : devices) device.start();
    std::vector<std::thread> writers;
    writers.reserve(units);
    for (DeviceThread& device : devices)
      writers.emplace_back([&tally, &written, &device] {
        for (int i = 0; i < writes || tally.ok == 0; ++i) {
          Write write;
          write.registers[0] = static_cast<std::uint16_t>(i);
          write.listener = &tally;
          device.write(write);
          ++written;
          if (i % 10 == 0) std::this_thread::sleep_for(milliseconds(3));
        }
      });
    for (std::thread& writer : writers) writer.join();
  }
  EXPECT_EQ(tally.all, written);
  EXPECT_GT(tally.ok, 0);
}

}  // namespace
}  // namespace coupler::host
