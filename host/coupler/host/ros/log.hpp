// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "coupler/host/core/sink.hpp"

namespace coupler::host {

/// A ROS node's log: console and /rosout. Any thread may call. What is logged may come from a device, so it
/// is escaped as printable_lines() does.
class Log {
 public:
  virtual ~Log() = default;
  virtual void log(Level level, const std::string& text) = 0;
  /// Whether log_debug() shows anything; costs nothing.
  virtual bool shows_debug() const = 0;
  virtual void log_debug(const std::string& text) = 0;
};

/// Before there is a node: to standard error, escaped in the same way.
void print(std::string_view text);

}  // namespace coupler::host
