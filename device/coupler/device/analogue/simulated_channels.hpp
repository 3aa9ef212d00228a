// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "coupler/codec/number.hpp"
#include "coupler/device/core/channels.hpp"
#include "coupler/device/core/image.hpp"

namespace coupler::device {

/// Channels without hardware (`--sim`): outputs take what a PWM, or a DAC that tells no limits, takes, and
/// inputs have the value that the image has, which the field side sets.
class SimulatedChannels : public Channels {
 public:
  /// The image outlives it.
  explicit SimulatedChannels(const Image& image) : image_(image) {}

  std::optional<double> read(const Point& input, TimePoint) override {
    return codec::published(image_.find(input.table, range(input)).data(), input.format, input.scale);
  }
  bool accepts(const Point& output, double value) const override {
    return !output.pwm.present() || is_duty_cycle(value);
  }
  Outcome drive(const Point&, double) override { return Outcome::done; }

 private:
  const Image& image_;
};

}  // namespace coupler::device
