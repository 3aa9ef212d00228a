// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <utility>

#include "coupler/device/core/edges.hpp"
#include "coupler/map/hardware.hpp"

namespace coupler::device {

/// Counts the edges that the kernel reports of one line, and those that it cannot have reported.
class EdgeTally {
 public:
  /// `watched`: which edges are reported. `level`: the line's when reporting began.
  EdgeTally(Edge watched, bool level) : watched_(watched), latest_(level) {}

  /// Two equal edges in a row on a line watched for both: there was one between them.
  void edge(bool rising) {
    if (watched_ == Edge::both && latest_is_known_ && rising == latest_) ++edges_.lost;
    latest_ = rising;
    latest_is_known_ = true;
    ++(rising ? edges_.rising : edges_.falling);
  }

  /// The kernel dropped at least so many.
  void lose(std::uint32_t count) {
    edges_.lost += count;
    latest_is_known_ = false;
  }

  /// What was counted since the last call.
  Edges take() { return std::exchange(edges_, {}); }

 private:
  Edge watched_;
  bool latest_;
  bool latest_is_known_ = true;
  Edges edges_;
};

}  // namespace coupler::device
