// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "coupler/device/core/time.hpp"

namespace coupler::device {

/// The events on an input since it was asked last. Edges are logical (after active_low).
struct Edges {
  std::uint32_t rising = 0;
  std::uint32_t falling = 0;
  std::uint32_t lost = 0;  ///< at least so many more; of which kind is not known

  constexpr bool any() const { return (rising | falling | lost) != 0; }
};

/// Receives the edges of inputs from Lines::take_edges(). `input` is the address of a discrete input.
class EdgeSink {
 public:
  /// Receives the edges of counters and latched points.
  virtual void add(std::uint16_t input, const Edges& edges) = 0;

  /// The input has `level` since `at`: the time stamp of the edge, as precise as the hardware tells it. Each
  /// change is told once, those of one input in the order of their times; those of different inputs are not
  /// in order. Twice the same level in a row: what was between was lost().
  virtual void changed(std::uint16_t input, bool level, TimePoint at) = 0;

  /// At least so many changes of inputs were not seen, or not kept, and will not be told. The level of each
  /// input is told all the same, if it is another one than was told last. Counters and latched points are
  /// told of the same loss by add().
  virtual void lost(std::uint32_t changes) = 0;

 protected:
  ~EdgeSink() = default;
};

}  // namespace coupler::device
