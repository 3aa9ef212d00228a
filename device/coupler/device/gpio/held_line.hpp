// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <tuple>

#include "coupler/device/gpio/line_spec.hpp"

namespace coupler::device {

/// A line of this machine and how it was requested. It outlives the map that asked for it.
struct HeldLine {
  std::string chip;  ///< the kernel's name
  unsigned offset = 0;
  bool output = false;
  bool active_low = false;
  Bias bias = Bias::as_is;
  Drive drive = Drive::push_pull;
  std::chrono::microseconds debounce{0};
  std::optional<Edge> counted{};
};

inline HeldLine held_as(const LineSpec& wanted) {
  const Line& line = wanted.point->line;
  return {wanted.line.chip->name, wanted.line.offset, is_output(wanted),
          line.active_low,        line.bias,          line.drive,
          line.debounce,          wanted.counted};
}

inline bool is_same_line(const HeldLine& a, const HeldLine& b) {
  return a.chip == b.chip && a.offset == b.offset;
}

/// The same line, and nothing to be changed about it.
inline bool operator==(const HeldLine& a, const HeldLine& b) {
  const auto settings = [](const HeldLine& line) {
    return std::tie(line.output, line.active_low, line.bias, line.drive, line.debounce, line.counted);
  };
  return is_same_line(a, b) && settings(a) == settings(b);
}

}  // namespace coupler::device
