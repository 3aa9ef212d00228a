// SPDX-License-Identifier: Apache-2.0
// PWM channels by their files, as the kernel's Documentation/ABI/testing/sysfs-class-pwm says.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <tl/expected.hpp>

#include "coupler/device/analogue/attribute.hpp"
#include "coupler/device/core/time.hpp"
#include "coupler/map/hardware.hpp"

namespace coupler::device {

/// A PWM channel. It is taken over as it runs, and it is never disabled or given back, so a program that is
/// started anew moves nothing but the duty cycle.
class PwmOutput {
 public:
  /// Finds the channel below `sysfs` (usually "/sys") and asks the kernel for it; nothing of its output
  /// changes. udev needs a moment to give a new channel's files to the group: it has until then. The error
  /// says what is there instead, and the remedy.
  static tl::expected<PwmOutput, std::string> open(const std::string& sysfs, const Pwm& wanted,
                                                   TimePoint until = {});

  /// Returns a text for the log: "pwmchip0 (fan) channel 0".
  const std::string& name() const { return name_; }
  /// The folder of its files.
  const std::string& folder() const { return folder_; }

  /// `percent` of the period, 0 … 100; the first time, the period is set and the output enabled too. Returns
  /// 0 or an errno.
  [[nodiscard]] int drive(double percent);

 private:
  PwmOutput(std::string name, std::string folder, Attribute duty, std::chrono::nanoseconds period)
      : name_(std::move(name)), folder_(std::move(folder)), duty_(std::move(duty)), period_(period) {}

  int start(std::int64_t duty);

  std::string name_;
  std::string folder_;
  Attribute duty_;  ///< ns
  std::chrono::nanoseconds period_;
  bool is_started_ = false;
};

}  // namespace coupler::device
