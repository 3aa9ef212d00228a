// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "coupler/host/core/clock.hpp"

namespace coupler::host {

/// Durations from 1 µs to about a minute, counted in steps of an eighth of each power of two: a quantile is
/// at most 12.5 % too large. Of fixed size; a copy is a snapshot.
class Histogram {
 public:
  void add(Duration duration) {
    const auto micros =
        std::max<std::int64_t>(0, std::chrono::duration_cast<std::chrono::microseconds>(duration).count());
    ++counts_[step_of(static_cast<std::uint64_t>(micros))];
    ++count_;
    max_ = std::max(max_, duration);
  }

  std::uint64_t count() const { return count_; }
  Duration max() const { return max_; }

  /// Returns a duration that `share` (0 … 1) of them do not exceed; 0 if there are none.
  Duration quantile(double share) const {
    const double wanted = share * static_cast<double>(count_);
    std::uint64_t seen = 0;
    for (std::size_t i = 0; i < counts_.size(); ++i) {
      seen += counts_[i];
      if (counts_[i] != 0 && static_cast<double>(seen) >= wanted)
        return std::min<Duration>(std::chrono::microseconds(end_of(i)), max_);
    }
    return max_;
  }

 private:
  static constexpr std::size_t parts = 8;       ///< of each power of two
  static constexpr std::size_t exponents = 24;  ///< 8 µs … 2^26 µs; below 8 µs each has its own step

  static std::size_t step_of(std::uint64_t micros) {
    std::size_t exponent = 0;
    while (micros >= 2 * parts && exponent + 1 < exponents) {
      micros /= 2;
      ++exponent;
    }
    return exponent * parts + static_cast<std::size_t>(std::min<std::uint64_t>(micros, 2 * parts - 1));
  }
  /// The largest of a step, and a little more.
  static std::int64_t end_of(std::size_t step) {
    if (step < 2 * parts) return static_cast<std::int64_t>(step) + 1;
    const std::size_t exponent = step / parts - 1;
    return static_cast<std::int64_t>((step - exponent * parts + 1) << exponent);
  }

  std::array<std::uint64_t, (exponents + 1) * parts> counts_{};
  std::uint64_t count_ = 0;
  Duration max_{0};
};

}  // namespace coupler::host
