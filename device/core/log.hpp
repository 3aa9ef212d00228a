// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace coupler::node {

/// Where the node says what happens. Each call is one line, without a newline.
class Log {
 public:
  /// What somebody may want to know.
  virtual void write(std::string_view line) = 0;
  /// What somebody should look at: something fails, or was lost.
  virtual void warn(std::string_view line) { write(line); }
  /// What keeps the node, or a new map, from being served.
  virtual void fail(std::string_view line) { write(line); }

 protected:
  ~Log() = default;
};

}  // namespace coupler::node
