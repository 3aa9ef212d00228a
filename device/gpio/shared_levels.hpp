// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "common/base/span.hpp"

namespace coupler::node {

/// Levels in memory that a process shares with those that it forks: the keeper has to know what the I/O
/// process drove before it died.
class SharedLevels {
 public:
  /// All 0. Throws std::bad_alloc like any container.
  explicit SharedLevels(std::size_t count);
  SharedLevels(const SharedLevels&) = delete;
  SharedLevels& operator=(const SharedLevels&) = delete;
  ~SharedLevels();

  Span<int> all() { return levels_; }

 private:
  Span<int> levels_;
};

}  // namespace coupler::node
