// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>

#include "coupler/host/core/write.hpp"

namespace coupler::host {

/// The last value of every output that was written, for `on_reconnect: restore`. Only the connection's owner
/// uses it.
class WrittenValues {
 public:
  explicit WrittenValues(OnReconnect policy) : kept_(policy == OnReconnect::restore) {}

  bool are_kept() const { return kept_; }
  void remember(const Write& write) {
    if (!kept_) return;
    Write& value = values_[write.point];
    value = write;
    value.listener = nullptr;
    value.ordered = false;
  }
  /// By point, in the order of the map.
  const std::map<std::uint32_t, Write>& all() const { return values_; }

 private:
  bool kept_;
  std::map<std::uint32_t, Write> values_;
};

}  // namespace coupler::host
