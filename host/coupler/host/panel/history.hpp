// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>

#include "coupler/host/core/clock.hpp"

namespace coupler::host {

/// The last ten minutes of a number, as the least and the greatest of each step. Fixed memory, no heap.
class History {
 public:
  static constexpr std::size_t steps = 300;
  static constexpr std::chrono::seconds step{2};

  struct Step {
    float least = std::numeric_limits<float>::quiet_NaN();  ///< NaN: nothing is known
    float greatest = std::numeric_limits<float>::quiet_NaN();
  };

  /// It has this value from now on; one that is not finite as a float is not known.
  void take(double value, Time at) {
    const auto number = static_cast<float>(value);
    if (!std::isfinite(number)) return lose(at);
    advance(at);
    Step& now = steps_[newest_ % steps];
    if (!(now.least <= number)) now.least = number;
    if (!(now.greatest >= number)) now.greatest = number;
    value_ = number;
  }
  /// Its value is not known from now on.
  void lose(Time at) {
    advance(at);
    value_ = std::numeric_limits<float>::quiet_NaN();
  }
  /// The oldest is 0, the step that is not over yet the last one.
  const Step& at(std::size_t i) const { return steps_[(newest_ + 1 + i) % steps]; }
  /// The number of the step that a time is in.
  static std::uint64_t number_of(Time at) { return static_cast<std::uint64_t>(at.time_since_epoch() / step); }
  /// Steps that have begun since the first value; at(i) of older ones is empty.
  void advance(Time at) {
    const std::uint64_t number = number_of(at);
    if (!std::exchange(has_begun_, true)) newest_ = number;
    for (std::size_t passed = 0; newest_ < number; ++newest_, ++passed) {
      if (passed == steps) {  // nobody has looked for longer than it lasts
        newest_ = number;
        break;
      }
      steps_[(newest_ + 1) % steps] = {value_, value_};
    }
  }

 private:
  std::array<Step, steps> steps_{};
  std::uint64_t newest_ = 0;  ///< a time, in steps
  bool has_begun_ = false;
  float value_ = std::numeric_limits<float>::quiet_NaN();
};

}  // namespace coupler::host
