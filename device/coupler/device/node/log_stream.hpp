// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string_view>

#include "coupler/device/net/descriptor.hpp"

namespace coupler::device {

/// Stderr, without waiting for whoever reads it: a terminal that was stopped, a pipe that is full. Other
/// programs that use it see no difference: O_NONBLOCK of a descriptor that they share would be theirs, too.
class LogStream {
 public:
  /// Stderr as it is now.
  LogStream();

  /// Returns how much of the text was written: what stderr takes at once.
  std::size_t write(std::string_view text) const;
  /// That write() needs besides stderr; -1: none.
  int descriptor() const { return own_.get(); }

 private:
  std::size_t write_some(std::string_view text) const;

  Descriptor
      own_;  ///< of the same pipe or terminal, does not block; closed: there can be none, or it needs none
  bool is_socket_ = false;
};

}  // namespace coupler::device
