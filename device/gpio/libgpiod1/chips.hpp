// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gpiod.h>

#include <memory>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "common/map/line.hpp"

namespace coupler::node::libgpiod1 {

/// Lines die with their chip: who uses a line keeps its chip.
using Chip = std::shared_ptr<gpiod_chip>;

struct FoundLine {
  Chip chip;
  gpiod_line* line = nullptr;
};

/// "gpiochip0 line 17 (GPIO17)".
std::string to_string(const FoundLine& found);

/// The GPIO chips of this machine.
class Chips {
 public:
  /// Opens those of /dev/gpiochip*.
  Chips();

  /// The line that the map means. The error says what there is instead.
  tl::expected<FoundLine, std::string> find(const Line& line) const;

 private:
  tl::expected<FoundLine, std::string> find_by_name(const std::string& name) const;
  tl::expected<FoundLine, std::string> find_by_offset(const std::string& chip, unsigned offset) const;
  tl::expected<Chip, std::string> find_chip(const std::string& wanted) const;
  /// "; this machine has gpiochip0 'label' (54 lines)", and what could not be opened, with the remedy.
  std::string inventory() const;

  std::vector<Chip> chips_;
  std::string unopened_;  ///< "/dev/gpiochip1: Permission denied"
};

}  // namespace coupler::node::libgpiod1
