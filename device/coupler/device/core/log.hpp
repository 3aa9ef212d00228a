// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <optional>
#include <string_view>

#include "coupler/device/core/time.hpp"

namespace coupler::device {

/// Where the node says what happens. Each call is one line, without a newline.
class Log {
 public:
  /// What somebody may want to know.
  virtual void write(std::string_view line) = 0;
  /// What somebody should look at: something fails, or was lost.
  virtual void warn(std::string_view line) { write(line); }
  /// What keeps the node, or a new map, from being served.
  virtual void fail(std::string_view line) { write(line); }

  /// Lines that clients can cause again and again. Of those of one kind, one a second is kept at most: the
  /// newest, with how many there were beside it.
  virtual void write_limited(std::string_view kind, std::string_view line) {
    (void)kind;
    write(line);
  }
  virtual void warn_limited(std::string_view kind, std::string_view line) {
    (void)kind;
    warn(line);
  }
  /// Says what was held back, when it is due. Returns how long it need not be called; nullopt: nothing waits.
  virtual std::optional<std::chrono::milliseconds> tick(TimePoint) { return std::nullopt; }

 protected:
  ~Log() = default;
};

}  // namespace coupler::device
