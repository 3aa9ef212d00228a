// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "coupler/host/core/stamp.hpp"

namespace coupler::client {

/// Holds the listener of each point, which is called with the new values. Any thread may use it.
class ValueListeners {
 public:
  /// Receives the registers of a value that differs from the one before, and the time at which it was true.
  using Listener = std::function<void(const std::uint16_t* registers, host::Stamp stamp)>;

  explicit ValueListeners(std::size_t points) : listeners_(points) {}

  /// Replaces the listener of the point. Waits while another thread calls the old one.
  void set(std::uint32_t point, Listener listener);
  /// Calls the listener of the point, if it has one. One thread at a time; a listener must not throw.
  void call(std::uint32_t point, const std::uint16_t* registers, host::Stamp stamp);

 private:
  std::mutex mutex_;
  std::vector<std::shared_ptr<const Listener>>
      listeners_;                        ///< shared: one may replace itself while it is called
  std::optional<std::uint32_t> called_;  ///< the point whose listener is being called
  std::thread::id caller_;
  std::uint64_t calls_ = 0;
  std::condition_variable returned_;
};

}  // namespace coupler::client
