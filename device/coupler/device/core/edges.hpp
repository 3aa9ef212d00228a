// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace coupler::device {

/// What happened on an input since it was last asked. Edges are logical (after active_low).
struct Edges {
  std::uint32_t rising = 0;
  std::uint32_t falling = 0;
  std::uint32_t lost = 0;  ///< at least so many more; of which kind is not known

  constexpr bool any() const { return (rising | falling | lost) != 0; }
};

/// Who is told of them.
class EdgeSink {
 public:
  /// `input`: address of a discrete input.
  virtual void add(std::uint16_t input, const Edges& edges) = 0;

 protected:
  ~EdgeSink() = default;
};

}  // namespace coupler::device
