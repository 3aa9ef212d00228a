// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gpiod.h>

#include <cerrno>
#include <memory>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "coupler/device/gpio/inventory.hpp"

namespace coupler::device::libgpiod1 {

/// Lines die with their chip: who uses a line keeps its chip.
using ChipHandle = std::unique_ptr<gpiod_chip, decltype(&gpiod_chip_close)>;

/// Lines of one chip that the kernel gave to this process. They are released at the end.
class Request {
 public:
  /// One to max_group_size lines of one chip with the same flags; outputs begin at their wanted levels,
  /// with no other level in between. `type`: GPIOD_LINE_REQUEST_…. The error names chip, line and
  /// holder.
  static tl::expected<std::unique_ptr<Request>, std::string> make(const std::vector<LineSpec>& lines,
                                                                  int type);

  ~Request();
  Request(const Request&) = delete;
  Request& operator=(const Request&) = delete;

  gpiod_line_bulk* bulk() { return &bulk_; }
  gpiod_line* first() { return gpiod_line_bulk_get_line(&bulk_, 0); }
  const std::string& name() const { return name_; }
  bool is_plugged() { return gpiod_line_update(first()) == 0 || errno != ENODEV; }

 private:
  Request(ChipHandle chip, const std::vector<LineSpec>& lines);

  ChipHandle chip_;
  gpiod_line_bulk bulk_;
  std::string name_;
};

/// The request flags that the map's keys stand for. Lines with different flags cannot share a request.
int flags_of(const Line& line);

}  // namespace coupler::device::libgpiod1
