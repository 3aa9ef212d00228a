// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "coupler/host/core/device.hpp"
#include "coupler/tools/device_looks.hpp"
#include "coupler/tools/read_only_map.hpp"
#include "test/fakes/map_builder.hpp"
#include "test/host/core/fake_clock.hpp"
#include "test/host/core/fake_device.hpp"

namespace coupler::tools::test {

using fakes::MapBuilder;
using host::test::FakeClock;
using host::test::FakeDevice;

/// A fake device, the engine that reads it, and the snapshots that DeviceLooks makes.
struct Looking {
  explicit Looking(const MapBuilder& builder, std::vector<bool> only = {})
      : Looking(builder.build(), std::move(only)) {}
  explicit Looking(MapPtr map, std::vector<bool> only = {})
      : owned(std::move(map)),
        chosen(only.empty() ? std::vector<bool>(owned->map().points.size(), true) : std::move(only)),
        engine(
            read_only.map(), {owned->map().verify, true},
            [this](std::string_view, std::string_view) { return loads; }, link, values, looks) {
    device.missing.insert({Table::input_registers, identity::reserved.start()});  // foreign
    for (std::uint32_t point = 0; point < chosen.size(); ++point)
      if (!chosen[point]) engine.want(point, false);
  }

  /// Runs the engine until there is a snapshot.
  Snapshot look() {
    snapshots.clear();
    for (host::Time due = engine.step(); snapshots.empty(); due = engine.step()) clock.sleep_until(due);
    return snapshots.back();
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
  std::vector<bool> chosen;
  ReadOnlyMap read_only{owned->map(), std::chrono::seconds(1)};
  host::Link link{host::test::share(device), owned->map().connection, owned->map().limits, &clock};
  host::ValueTable values{owned->map()};
  std::vector<Snapshot> snapshots;
  int silences = 0;  ///< how often it was told that a request had no answer
  DeviceLooks looks{read_only.map(),
                    chosen,
                    values,
                    clock,
                    [this](Snapshot snapshot) { snapshots.push_back(std::move(snapshot)); },
                    [this] { ++silences; }};
  host::Device engine;  // last: it uses the others
};

constexpr auto identity_question = "read input_registers 65280+13";

}  // namespace coupler::tools::test
