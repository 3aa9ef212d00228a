// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <string>

#include <fmt/format.h>

#include "coupler/host/panel/history.hpp"
#include "coupler/host/panel/word_bits.hpp"

namespace coupler::host {

inline std::string step_text(const NumberStep& step) {
  return std::isfinite(step.least) ? fmt::format("[{},{}]", step.least, step.greatest) : "null";
}

/// In hexadecimal, as WordBits::json().
inline std::string step_text(const BitsStep& step) {
  return (step.on | step.off) != 0 ? fmt::format(R"(["{:x}","{:x}"])", step.on, step.off) : "null";
}

/// The steps from `first` on: a list of [least, greatest], or of [on, off], or of null. JSON.
template <class Step>
std::string steps_text(const StepHistory<Step>& history, std::size_t first) {
  std::string text = "[";
  for (std::size_t i = first; i < history.steps; ++i)
    text += (i > first ? "," : "") + step_text(history.at(i));
  return text + ']';
}

}  // namespace coupler::host
