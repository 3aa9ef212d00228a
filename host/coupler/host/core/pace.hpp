// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "coupler/host/core/device_statistics.hpp"
#include "coupler/map/map.hpp"

namespace coupler::host {

/// Finds out whether a device keeps up with the rates of its map. It does not if a fifth of the cycles of ten
/// seconds are left out; one that is left out now and then is no trouble.
class Pace {
 public:
  /// To be called at least every second. Returns a warning when the device has become too slow: once, until
  /// it has kept up for a minute.
  std::optional<std::string> update(const Map& map, const DeviceSnapshot& now, Time at);
  /// Returns what is wrong; empty while the device keeps up.
  const std::string& trouble() const { return trouble_; }

 private:
  struct Counts {
    std::uint64_t done = 0;
    std::uint64_t left_out = 0;
  };
  void begin(const Counts& counts, Time at);

  Counts at_begin_;
  std::optional<Time> begun_;  ///< of the ten seconds
  int windows_kept_up_ = 0;    ///< in a row
  std::string trouble_;
};

}  // namespace coupler::host
