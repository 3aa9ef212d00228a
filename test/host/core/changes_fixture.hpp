// SPDX-License-Identifier: Apache-2.0
// A device that tells changes of its bits.
#pragma once

#include <algorithm>
#include <string>

#include "coupler/host/core/device.hpp"
#include "test/host/core/device_fixture.hpp"

namespace coupler::host::test {

using std::chrono::milliseconds;

using Publish = HostOptions::Publish;

/// A barrier (discrete input 3) and a lamp (coil 5), `on_change`, at 10 Hz.
inline fakes::MapBuilder cell() {
  fakes::MapBuilder builder;
  const auto on_change = [](Point& point) { point.host.publish = Publish::on_change; };
  builder.add(Table::discrete_inputs, "barrier", 3, codec::Type::BOOL, on_change);
  builder.add(Table::coils, "lamp", 5, codec::Type::BOOL, on_change);
  builder.head().connection.timeout = milliseconds(3000);
  return builder;
}

struct ChangesTest : DeviceTest {
  void begin(const MapBuilder& builder, std::uint32_t watchdog = 0) {
    serve(builder);
    device.tell_changes(watchdog);
    start(builder);
    run_for(milliseconds(10));
    device.requests.clear();
  }
  std::size_t reads() const {
    return static_cast<std::size_t>(
        std::count_if(device.requests.begin(), device.requests.end(),
                      [](const std::string& request) { return request.rfind("read", 0) == 0; }));
  }
  std::uint32_t barrier() const {
    return static_cast<std::uint32_t>(find(owned->map(), "barrier") - owned->map().points.data());
  }
  std::size_t waits() const { return device.count("wait 1000"); }
};

}  // namespace coupler::host::test
