// SPDX-License-Identifier: Apache-2.0
// The GPIO lines of this machine, and those of them that a map wants.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "coupler/map/hardware.hpp"
#include "coupler/map/point.hpp"

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

  /// Those of /dev/gpiochip*, or of another folder. A link beside them leads to a chip that is listed anyway.
  explicit Inventory(ReadChip read, const std::string& folder = "/dev");
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

/// A point of the map and the line behind it: a coil's is an output, a discrete input's an input.
struct LineSpec {
  const Point* point = nullptr;
  FoundLine line;
  std::optional<Edge> counted;  ///< the edges that counters and latched points want of it
  int level = 0;                ///< that an output begins with
  bool watched = true;          ///< an input: its edges are wanted, to tell each change
};

inline bool is_output(const LineSpec& wanted) { return wanted.point->table == Table::coils; }
inline bool is_watched(const LineSpec& wanted) { return !is_output(wanted) && wanted.watched; }

/// "gpiochip0 line 5 (GPIO5), gpiochip0 line 6 (GPIO6) and 3 more".
std::string names_of(const std::vector<LineSpec>& lines);

/// The holder of a line of the chip: the consumer's name, empty if it has none; nullopt: nobody holds it.
using HolderOf = std::function<std::optional<std::string>(unsigned offset)>;

/// Why the kernel refused to give these lines with `error` (an errno), and what to do. The kernel refuses a
/// request as a whole; which line is the reason is found line by line.
std::string request_error(const std::vector<LineSpec>& lines, int error, const HolderOf& holder_of);

}  // namespace coupler::device
