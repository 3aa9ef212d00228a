// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "coupler/device/core/time.hpp"
#include "coupler/map/point.hpp"

namespace coupler::device {

/// The hardware behind registers: ADC and DAC channels, PWM. Values are physical: V, A, °C …, the duty cycle
/// of a PWM in percent. Points are analogue ones of the map that it was made for. Whoever implements it says
/// in the log what failed, once per change of state.
class Channels {
 public:
  enum class Outcome {
    done,
    refused,  ///< the hardware works, but does not take this value
    failed,
    absent  ///< the hardware is unplugged
  };

  virtual ~Channels() = default;

  /// The newest value of an input, without waiting for the hardware; nullopt: it cannot be read.
  [[nodiscard]] virtual std::optional<double> read(const Point& input, TimePoint now) = 0;

  /// Returns whether an output can be driven to a finite value, as far as that is known before it is tried.
  [[nodiscard]] virtual bool accepts(const Point& output, double value) const = 0;

  /// False: the hardware behind an output is known to be unplugged.
  virtual bool is_plugged(const Point&) const { return true; }

  /// Drives an output to a value that it accepts. Unless it is done, the output is as it was, as far as the
  /// hardware tells.
  [[nodiscard]] virtual Outcome drive(const Point& output, double value) = 0;
};

}  // namespace coupler::device
