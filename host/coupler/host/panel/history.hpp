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

/// The last ten minutes of a value, in steps. Fixed memory, no heap. A `StepType` is what is known of a step,
/// nothing at first, and `add()` adds a value that it had.
template <class StepType>
class StepHistory {
 public:
  using Step = StepType;
  static constexpr std::size_t steps = 300;
  static constexpr std::chrono::seconds step{2};

  /// It has this value from now on.
  void take(const Step& value, Time at) {
    advance(at);
    steps_[newest_ % steps].add(value);
    value_ = value;
  }
  /// Its value is not known from now on.
  void lose(Time at) {
    advance(at);
    value_ = {};
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
      steps_[(newest_ + 1) % steps] = value_;
    }
  }

 private:
  std::array<Step, steps> steps_{};
  std::uint64_t newest_ = 0;  ///< a time, in steps
  bool has_begun_ = false;
  Step value_{};
};

/// The least and the greatest number of a step.
struct NumberStep {
  float least = std::numeric_limits<float>::quiet_NaN();  ///< NaN: nothing is known
  float greatest = std::numeric_limits<float>::quiet_NaN();

  void add(const NumberStep& value) {
    if (!(least <= value.least)) least = value.least;
    if (!(greatest >= value.greatest)) greatest = value.greatest;
  }
};

/// That of a number.
class History : public StepHistory<NumberStep> {
 public:
  /// A value that is not finite as a float is not known.
  void take(double value, Time at) {
    const auto number = static_cast<float>(value);
    if (!std::isfinite(number)) return lose(at);
    StepHistory::take({number, number}, at);
  }
};

}  // namespace coupler::host
