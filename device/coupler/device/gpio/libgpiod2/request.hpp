// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gpiod.h>

#include <array>
#include <cerrno>
#include <memory>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "coupler/base/span.hpp"
#include "coupler/device/gpio/inventory.hpp"
#include "coupler/device/gpio/line_group.hpp"

namespace coupler::device::libgpiod2 {

/// A libgpiod object that its own function frees.
template <class Object, void (*free)(Object*)>
struct Free {
  void operator()(Object* object) const { free(object); }
};
template <class Object, void (*free)(Object*)>
using Owned = std::unique_ptr<Object, Free<Object, free>>;

using ChipHandle = Owned<gpiod_chip, gpiod_chip_close>;
using RequestHandle = Owned<gpiod_line_request, gpiod_line_request_release>;

/// Lines that the kernel gave to this process, and their chip.
struct Request {
  ChipHandle chip;
  RequestHandle lines;

  bool is_plugged() const {
    const Owned<gpiod_chip_info, gpiod_chip_info_free> info(gpiod_chip_get_info(chip.get()));
    return info || errno != ENODEV;
  }

  /// The levels of all of them. Returns 0 or an errno.
  int read(Span<int> levels) const {
    std::array<gpiod_line_value, max_group_size> values{};
    if (gpiod_line_request_get_values(lines.get(), values.data()) != 0) return errno;
    for (std::size_t i = 0; i < levels.size(); ++i) levels[i] = values[i] == GPIOD_LINE_VALUE_ACTIVE ? 1 : 0;
    return 0;
  }
};

/// One to max_group_size lines of one chip, all outputs or all inputs, requested as the map says; inputs that
/// are watched report their edges. Outputs begin at their wanted levels, with no other level in between. The
/// error names chip, line and holder.
tl::expected<Request, std::string> request(const std::vector<LineSpec>& lines);

/// The kernel describes a request's lines with at most 10 attributes, whatever their number. That is enough
/// for as many different sets of flags as this, and the levels of outputs.
constexpr std::size_t max_kinds = 5;

/// Returns whether two lines differ in a setting that needs an attribute.
bool same_kind(const LineSpec& a, const LineSpec& b);

}  // namespace coupler::device::libgpiod2
