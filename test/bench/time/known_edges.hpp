// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "test/bench/kernel/line.hpp"
#include "test/bench/kernel/wire.hpp"

namespace coupler::bench {

/// Edges of a gpio-sim chip whose stamps are known though the line is somebody else's. The chip makes an edge
/// at the next tick of the kernel, not when a wire is pulled, and those of one tick in the order of the
/// lines. So a line of our own before it and one behind it are pulled along.
class KnownEdges {
 public:
  /// `wires` is the folder of the chip's simulated lines. Its lines 0 and 5 are ours.
  KnownEdges(const char* chip, const std::string& wires);

  /// In ns, CLOCK_MONOTONIC.
  struct Stamp {
    std::int64_t earliest;
    std::int64_t latest;
  };
  /// Pulls the wire of a line between them.
  void pull(const Wire& wire, bool level) const;
  /// Of the last pull; waits for it. nullopt: a tick came between the lines, so it is not known.
  std::optional<Stamp> stamp() const;

 private:
  Wire before_;
  Wire behind_;
  Line first_;
  Line last_;
};

}  // namespace coupler::bench
