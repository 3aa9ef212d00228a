// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "coupler/map/hardware.hpp"

namespace coupler::device {

struct Chip {
  std::string path;                ///< "/dev/gpiochip0"
  std::string name;                ///< the kernel's: "gpiochip0"
  std::string label;               ///< the driver's: "pinctrl-bcm2711"
  std::vector<std::string> lines;  ///< their names, by offset; empty where a line has none
};

struct FoundLine {
  const Chip* chip = nullptr;  ///< one of the inventory's
  unsigned offset = 0;
};

/// "gpiochip0 line 17 (GPIO17)".
std::string to_string(const FoundLine& found);

/// The GPIO chips of this machine. Their lines live as long as it does.
class Inventory {
 public:
  /// Reads one chip; nullopt with errno set if it cannot be opened.
  using ReadChip = std::optional<Chip> (*)(const std::string& path);

  /// Those of /dev/gpiochip*.
  explicit Inventory(ReadChip read);
  explicit Inventory(std::vector<Chip> chips) : chips_(std::move(chips)) {}

  /// The line that the map means. The error says what there is instead.
  tl::expected<FoundLine, std::string> find(const Line& line) const;

 private:
  tl::expected<FoundLine, std::string> find_by_name(std::string_view name) const;
  tl::expected<FoundLine, std::string> find_by_offset(const std::string& chip, unsigned offset) const;
  tl::expected<const Chip*, std::string> find_chip(const std::string& wanted) const;
  /// "; this machine has gpiochip0 'label' (54 lines)", and what could not be opened, with the remedy.
  std::string contents() const;

  std::vector<Chip> chips_;
  std::string unopened_;  ///< "/dev/gpiochip1: Permission denied"
};

}  // namespace coupler::device
