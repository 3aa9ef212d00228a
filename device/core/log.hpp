// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace coupler::node {

/// Where the node says what happens.
class Log {
 public:
  /// One line, without a newline.
  virtual void write(std::string_view line) = 0;

 protected:
  ~Log() = default;
};

}  // namespace coupler::node
