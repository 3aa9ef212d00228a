// SPDX-License-Identifier: Apache-2.0
// `priority: high` in a generated client: of test/generate/manners.yaml, whose horn has it.
#include <gtest/gtest.h>

#include <chrono>
#include <future>
#include <mutex>
#include <vector>

#include "manners_client.hpp"
#include "test/host/modbus/modbus_server.hpp"

namespace coupler::client {
namespace {

constexpr int horn = 21;  // its address

TEST(ClientPriority, What_is_set_with_high_priority_goes_before_all_that_waits) {
  std::promise<void> may_go_on;
  std::promise<void> holds;
  std::mutex mutex;
  std::vector<int> written;  // addresses
  host::test::ModbusServer server;
  server.on_write = [&](int address) {
    {
      const std::lock_guard lock(mutex);
      written.push_back(address);
      if (written.size() > 1) return;
    }
    holds.set_value();
    may_go_on.get_future().wait();
  };
  Options options;
  options.address = "127.0.0.1";
  options.port = server.port();
  maps::manners::Client client{options};
  client.connect();
  ASSERT_TRUE(client.wait_online(std::chrono::seconds(20)));
  std::vector<PendingWrite> pending;
  pending.push_back(client.lamps.set({true}));
  holds.get_future().wait();
  pending.push_back(client.lamps.set({false}));
  pending.push_back(client.lamps.set({false, true}));
  pending.push_back(client.horn.set(true));
  may_go_on.set_value();
  for (PendingWrite& each : pending) EXPECT_TRUE(each.get());
  const std::lock_guard lock(mutex);
  EXPECT_EQ(written.at(1), horn);
}

}  // namespace
}  // namespace coupler::client
