// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "pump_client.hpp"
#include "test/host/modbus/modbus_server.hpp"

namespace coupler::client {

constexpr std::chrono::seconds soon(20);

/// Keeps what a client reports. `texts` may be read while the client has no connection.
struct Reports {
  void add(const std::string& text) {
    const std::lock_guard lock(mutex);
    texts.push_back(text);
  }

  std::mutex mutex;
  std::vector<std::string> texts;
};

/// A generated client, config/examples/pump, and a server that libmodbus makes.
struct PumpClient : ::testing::Test {
  Options options() const {
    Options options;
    options.address = "127.0.0.1";
    options.port = server.port();
    return options;
  }
  /// Whether it comes true.
  template <class Condition>
  static bool becomes(Condition condition) {
    for (const auto end = std::chrono::steady_clock::now() + soon; std::chrono::steady_clock::now() < end;) {
      if (condition()) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return condition();
  }

  host::test::ModbusServer server;
  maps::pump::Client pump{options()};
};

}  // namespace coupler::client
