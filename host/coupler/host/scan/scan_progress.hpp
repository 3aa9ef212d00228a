// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

namespace coupler::scan {

/// Who follows a scan, and may end it.
class ScanProgress {
 public:
  virtual ~ScanProgress() = default;

  /// A step begins, as "unit ids" or "coils".
  virtual void begins(std::string_view step) = 0;
  /// `done` of `total` are behind, roughly; `requests` were made since the start.
  virtual void moved(std::uint32_t done, std::uint32_t total, std::uint64_t requests) = 0;
  /// No further request is to be made.
  virtual bool wants_end() const = 0;
};

}  // namespace coupler::scan
