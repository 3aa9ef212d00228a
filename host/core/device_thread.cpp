// SPDX-License-Identifier: Apache-2.0
#include "host/core/device_thread.hpp"

#include <utility>

namespace coupler::driver {

DeviceThread::DeviceThread(const Map& map, Verify verify, MapLoader load, Transport& transport, Sink& sink)
    : transport_(transport),
      device_(map, verify, std::move(load), transport, clock_, writes_, sink),
      thread_([this] { run(); }) {}

DeviceThread::~DeviceThread() {
  stopping_ = true;
  clock_.stop();
  writes_.stop();
  transport_.interrupt();
  thread_.join();
}

void DeviceThread::run() {
  while (!stopping_) writes_.wait_until(device_.step());
  device_.stop();
}

}  // namespace coupler::driver
