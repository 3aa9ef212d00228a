// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "coupler/device/core/edges.hpp"
#include "coupler/device/core/time.hpp"

namespace coupler::device {

/// A file descriptor on which the kernel reports edges. Whoever runs the event loop watches it.
class EventSource {
 public:
  virtual ~EventSource() = default;
  virtual int descriptor() const = 0;
  /// Takes the waiting edges without blocking. False: the line is gone (its chip was unplugged); the
  /// descriptor stays readable for ever, so do not watch it any more.
  [[nodiscard]] virtual bool take_edges() = 0;
  /// The edges of the group's i-th line that were taken and not told yet.
  virtual Edges edges(std::size_t line, TimePoint now) = 0;
};

}  // namespace coupler::device
