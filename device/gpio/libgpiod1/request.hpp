// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "common/map/point.hpp"
#include "device/gpio/libgpiod1/chips.hpp"

namespace coupler::node::libgpiod1 {

/// A point of the map and the line behind it.
struct Wanted {
  const Point* point = nullptr;
  FoundLine found;
};

enum class Use { input, output, edges };

/// Lines of one chip that the kernel gave to this process. They are released at the end.
class Request {
 public:
  /// One to max_group_size lines of one chip with the same flags; outputs begin at their points' initial
  /// levels, with no other level in between. The error names chip, line and holder.
  static tl::expected<std::unique_ptr<Request>, std::string> make(const std::vector<Wanted>& lines, Use use);

  ~Request();
  Request(const Request&) = delete;
  Request& operator=(const Request&) = delete;

  gpiod_line_bulk* bulk() { return &bulk_; }
  gpiod_line* first() { return gpiod_line_bulk_get_line(&bulk_, 0); }
  const std::string& name() const { return name_; }

 private:
  explicit Request(const std::vector<Wanted>& lines);

  Chip chip_;
  gpiod_line_bulk bulk_;
  std::string name_;
};

/// The request flags that the map's keys stand for. Lines with different flags cannot share a request.
int flags_of(const Line& line);

/// The level that an output begins with.
int initial_level(const Point& point);

}  // namespace coupler::node::libgpiod1
