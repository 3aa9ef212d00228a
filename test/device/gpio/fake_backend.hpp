// SPDX-License-Identifier: Apache-2.0
// A backend in the place of libgpiod's, on chips that the test makes.
#pragma once

#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "coupler/device/gpio/inventory.hpp"

namespace coupler::device {

/// The machine: chips, who holds which line, and what was done to each wire.
struct Machine {
  std::vector<Chip> chips{{"/dev/gpiochip0", "gpiochip0", "plant", std::vector<std::string>(8)}};
  std::set<std::pair<std::string, unsigned>> held;
  std::map<unsigned, int> levels;    ///< by offset, of outputs that were driven
  std::vector<std::string> history;  ///< "take 0 1", "drive 0 1", "release 0"
  std::set<std::string> gone;        ///< chips whose lines are not there any more
  std::set<unsigned> refused;        ///< offsets that cannot be requested
  std::set<unsigned> silent;         ///< offsets that cannot report edges
  std::size_t watched = 64;          ///< how many inputs can be watched
};
/// Of the test that runs.
inline Machine machine;

}  // namespace coupler::device
