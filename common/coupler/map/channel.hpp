// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <string_view>

namespace coupler {

/// The channel of Linux's Industrial I/O behind a register point: an input (ADC, sensor) behind an input
/// register, an output (DAC) behind a holding register. The point's value (raw × gain + offset, see
/// codec::Scale) is the channel's in V, A, °C, … : the SI unit of what the kernel gives in thousandths.
struct Iio {
  std::string_view device;   ///< its name, label or "iio:device0"
  std::string_view channel;  ///< "voltage0", "temp"

  constexpr bool present() const { return !device.empty(); }
};

/// The PWM channel behind a holding register. The point's value is the duty cycle in percent, 0 … 100.
struct Pwm {
  std::string_view chip;  ///< "pwmchip0", or the name of the device that has it
  std::uint16_t channel = 0;
  std::chrono::nanoseconds period{0};

  constexpr bool present() const { return !chip.empty(); }
};

}  // namespace coupler
