// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>

#include "coupler/host/modbus/descriptor.hpp"

namespace coupler::host {

/// Something that happens once and that poll() can wait for. Any thread may set it.
class Event {
 public:
  Event();
  void set();
  /// Whoever sees it set sees what was done before.
  bool is_set() const { return set_.load(std::memory_order_acquire); }
  /// Readable from set() on.
  int fd() const { return fd_.get(); }

 private:
  Descriptor fd_;
  std::atomic<bool> set_{false};
};

}  // namespace coupler::host
