// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <optional>
#include <string_view>

#include "coupler/device/core/time.hpp"

namespace coupler::device {

/// The node's log. Each call is one line, without a newline.
class Log {
 public:
  /// Information.
  virtual void write(std::string_view line) = 0;
  /// A warning: something fails, or was lost.
  virtual void warn(std::string_view line) { write(line); }
  /// An error: the node cannot serve, or refuses a map.
  virtual void fail(std::string_view line) { write(line); }

  /// Lines that clients can cause again and again. Of each kind at most one a second is logged: the newest,
  /// with the number of the others.
  virtual void write_limited(std::string_view kind, std::string_view line) {
    (void)kind;
    write(line);
  }
  virtual void warn_limited(std::string_view kind, std::string_view line) {
    (void)kind;
    warn(line);
  }
  /// Logs lines that were held back and are due. Returns how long it need not be called; nullopt: none waits.
  virtual std::optional<std::chrono::milliseconds> tick(TimePoint) { return std::nullopt; }

 protected:
  ~Log() = default;
};

}  // namespace coupler::device
