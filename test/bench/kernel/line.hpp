// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace coupler::bench {

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

 private:
  int descriptor_;
};

}  // namespace coupler::bench
