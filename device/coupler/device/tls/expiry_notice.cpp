// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/tls/expiry_notice.hpp"

namespace coupler::device {

// The clock may be set at any time: so it is looked at more often than something can be told.
constexpr std::chrono::hours between_looks(1);
constexpr std::chrono::hours between_lines(24);

std::optional<std::chrono::milliseconds> ExpiryNotice::time_until_due(TimePoint now) const {
  if (!validity_) return std::nullopt;
  if (due_ <= now) return std::chrono::milliseconds(0);
  return std::chrono::ceil<std::chrono::milliseconds>(due_ - now);
}

void ExpiryNotice::tick(TimePoint now, WallTime wall_time) {
  if (!validity_ || now < due_) return;
  const auto text = expiry_text(*validity_, wall_time);
  if (text) log_.warn("the node's certificate " + *text);
  due_ = now + (text ? between_lines : between_looks);
}

}  // namespace coupler::device
