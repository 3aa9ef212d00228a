// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "coupler/host/cli/device_reader.hpp"
#include "test/fakes/map_builder.hpp"
#include "test/host/core/fake_clock.hpp"
#include "test/host/core/fake_device.hpp"

namespace coupler::cli::test {

using fakes::MapBuilder;
using host::test::FakeClock;
using host::test::FakeDevice;

/// A device without a network and what looks at it.
struct Looking {
  explicit Looking(const MapBuilder& builder, std::vector<bool> chosen = {})
      : owned(builder.build()),
        reader(owned->map(), chosen.empty() ? std::vector<bool>(owned->map().points.size(), true) : chosen,
               link, [this](std::string_view, std::string_view) { return loads; }) {
    device.missing.insert({Table::input_registers, identity::reserved.start()});  // foreign
  }

  const Map& map() const { return owned->map(); }
  std::uint32_t index(std::string_view name) const {
    return static_cast<std::uint32_t>(find(map(), name) - map().points.begin());
  }
  static const Reading& of(const Snapshot& snapshot, std::uint32_t point) {
    return *std::find_if(snapshot.readings.begin(), snapshot.readings.end(),
                         [point](const Reading& reading) { return reading.point == point; });
  }
  const Reading& of(const Snapshot& snapshot, std::string_view name) const {
    return of(snapshot, index(name));
  }
  /// The requests since the last call.
  std::vector<std::string> requests() { return std::exchange(device.requests, {}); }

  MapPtr owned;
  LoadResult loads;  ///< what the text of the device's map is
  FakeDevice device;
  FakeClock clock;
  host::Link link{host::test::share(device), owned->map().connection, owned->map().limits, &clock};
  DeviceReader reader;
};

constexpr auto identity_question = "read input_registers 65280+13";

}  // namespace coupler::cli::test
