// SPDX-License-Identifier: Apache-2.0
// What a node has behind a point: a GPIO line, an analogue channel, the edges of an input.
#pragma once

#include <chrono>
#include <cstdint>
#include <string_view>

#include "coupler/base/enumeration.hpp"

namespace coupler {

enum class Bias : std::uint8_t { as_is, none, pull_up, pull_down };
constexpr Enumeration<Bias, 4> enumeration(Bias) {
  return {"Bias",
          {{Bias::as_is, "as_is", ""},
           {Bias::none, "none"},
           {Bias::pull_up, "pull_up"},
           {Bias::pull_down, "pull_down"}}};
}

enum class Drive : std::uint8_t { push_pull, open_drain, open_source };
constexpr Enumeration<Drive, 3> enumeration(Drive) {
  return {"Drive",
          {{Drive::push_pull, "push_pull"},
           {Drive::open_drain, "open_drain"},
           {Drive::open_source, "open_source"}}};
}

/// The behaviour of an output that no client controls any more.
enum class Safe : std::uint8_t { off, on, hold };
constexpr Enumeration<Safe, 3> enumeration(Safe) {
  return {"Safe", {{Safe::off, "off"}, {Safe::on, "on"}, {Safe::hold, "hold"}}};
}

/// The GPIO line behind a coil or discrete input. Either `chip` and `offset`, or the line's `name`.
struct Line {
  std::string_view chip;  ///< "gpiochip0", "/dev/gpiochip0" or the chip's label
  std::uint32_t offset = 0;
  std::string_view name;  ///< "GPIO17": the kernel's name of the line, on any chip; empty if `chip` is given
  bool active_low = false;
  Bias bias = Bias::as_is;
  Drive drive = Drive::push_pull;         ///< outputs
  std::chrono::microseconds debounce{0};  ///< inputs: how long a level must be stable before an edge counts

  constexpr bool present() const { return !chip.empty() || !name.empty(); }
};

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

/// Returns whether a PWM can be driven to this value.
constexpr bool is_duty_cycle(double percent) { return percent >= 0 && percent <= 100; }

enum class Edge : std::uint8_t { rising, falling, both };
constexpr Enumeration<Edge, 3> enumeration(Edge) {
  return {"Edge", {{Edge::rising, "rising"}, {Edge::falling, "falling"}, {Edge::both, "both"}}};
}

/// The edges of a discrete input.
struct EdgeOf {
  std::string_view input;  ///< the point's name
  Edge edge = Edge::rising;

  constexpr bool present() const { return !input.empty(); }
};

}  // namespace coupler
