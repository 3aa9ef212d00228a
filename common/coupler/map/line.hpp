// SPDX-License-Identifier: Apache-2.0
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

/// What an output does when nobody is in command any more.
enum class Safe : std::uint8_t { off, on, hold };
constexpr Enumeration<Safe, 3> enumeration(Safe) {
  return {"Safe", {{Safe::off, "off"}, {Safe::on, "on"}, {Safe::hold, "hold"}}};
}

/// The GPIO line behind a coil or discrete input. Either `chip` and `offset`, or the line's `name`.
struct Line {
  std::string_view chip;  ///< "gpiochip0", "/dev/gpiochip0" or the chip's label
  std::uint32_t offset = 0;
  std::string_view
      name;  ///< "GPIO17": the kernel's name of the line, on whichever chip; empty if `chip` is given
  bool active_low = false;
  Bias bias = Bias::as_is;
  Drive drive = Drive::push_pull;  ///< outputs
  std::chrono::microseconds debounce{
      0};  ///< inputs: an edge counts once the level has been stable for so long

  constexpr bool present() const { return !chip.empty() || !name.empty(); }
};

}  // namespace coupler
