// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <thread>

#include "host/core/device.hpp"
#include "host/core/steady_clock.hpp"

namespace coupler::driver {

/// Runs a device in its own thread, so that a dead one slows no other. That thread owns the connection.
class DeviceThread {
 public:
  DeviceThread(const Map& map, Verify verify, MapLoader load, Transport& transport, Sink& sink);
  /// Ends the request in progress and waits for the thread: milliseconds.
  ~DeviceThread();
  DeviceThread(const DeviceThread&) = delete;
  DeviceThread& operator=(const DeviceThread&) = delete;

  /// From any thread.
  WriteQueue& writes() { return writes_; }

 private:
  void run();

  Transport& transport_;
  SteadyClock clock_;
  WriteQueue writes_;
  Device device_;
  std::atomic<bool> stopping_{false};
  std::thread thread_;  // last: it uses the others
};

}  // namespace coupler::driver
