// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "coupler/host/core/stamp.hpp"
#include "coupler/map/map.hpp"
#include "coupler/plan/read_span.hpp"

namespace coupler::client {

/// The last value of each point, as registers (bit tables: each bit as one, 0 or 1). For any thread.
class LastValues {
 public:
  /// Gets the registers of a value that differs from the one before, and when it was true.
  using Listener = std::function<void(const std::uint16_t* registers, host::Stamp stamp)>;

  struct Value {
    std::vector<std::uint16_t> registers;
    host::Time at;
    bool earlier = false;  ///< read over a connection before this one
  };

  /// The map must outlive it.
  explicit LastValues(const Map& map) : map_(map), entries_(map.points.size()) {}

  /// A connection begins.
  void begin();
  /// Keeps values that were read, all at once. Then calls, in this thread, the listeners of points that have
  /// another value than before, or their first one. One thread at a time; a listener must not throw.
  void set(const plan::ReadSpan& span, Span<const std::uint16_t> registers, host::Stamp stamp);
  /// Takes the place of the listener before. Waits while one of this point is being called by another thread.
  void listen(std::uint32_t point, Listener listener);

  /// nullopt: none was read yet.
  std::optional<Value> get(std::uint32_t point) const;
  /// The same after waiting for the first one of this connection.
  std::optional<Value> wait(std::uint32_t point, std::chrono::milliseconds at_most) const;

 private:
  struct Entry {
    std::optional<Value> value;
    std::shared_ptr<const Listener> listener;  ///< shared: it may replace itself while it is called
  };
  struct News {
    std::uint32_t point;
    const std::uint16_t* registers;
  };
  /// Keeps a value. Returns whether it is another one.
  static bool keep(Entry& entry, const Point& point, const std::uint16_t* registers, host::Time at);
  void tell(const News& news, host::Stamp stamp);

  const Map& map_;
  mutable std::mutex mutex_;
  mutable std::condition_variable came_;
  std::vector<Entry> entries_;
  std::optional<std::uint32_t> called_;  ///< the point whose listener is being called
  std::thread::id caller_;
  std::uint64_t calls_ = 0;
  std::condition_variable returned_;
};

}  // namespace coupler::client
