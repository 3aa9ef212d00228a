// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace coupler::bench {

/// Flags of an input whose edges are reported.
extern const unsigned long long both_edges;

/// One line of a chip by the kernel's own interface (v2 of the GPIO character device), nothing between. What
/// must not happen in a benchmark ends the program with status 1 and a line on stderr.
class Line {
 public:
  /// `chip` as "/dev/gpiochip0"; `flags` are GPIO_V2_LINE_FLAG_*.
  Line(const char* chip, unsigned offset, unsigned long long flags);
  Line(const Line&) = delete;
  Line& operator=(const Line&) = delete;
  ~Line();

  bool read() const;
  void drive(bool level) const;

  struct Edge {
    std::int64_t at;  ///< ns, CLOCK_MONOTONIC: the kernel's stamp
    bool level;
  };
  /// The next edge, of a line that was requested with both_edges. Waits for it.
  Edge next_edge() const;

 private:
  int descriptor_;
};

}  // namespace coupler::bench
