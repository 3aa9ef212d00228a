// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
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
  };

  /// The map must outlive it.
  explicit LastValues(const Map& map) : map_(map), entries_(map.points.size()) {}

  /// Keeps values that were read, all at once. Then calls, in this thread, the listeners of points that have
  /// another value than before, or their first one.
  void set(const plan::ReadSpan& span, Span<const std::uint16_t> registers, host::Stamp stamp);
  void listen(std::uint32_t point, Listener listener);

  /// nullopt: none was read yet.
  std::optional<Value> get(std::uint32_t point) const;
  /// The same after waiting for the first one.
  std::optional<Value> wait(std::uint32_t point, std::chrono::milliseconds at_most) const;

 private:
  struct Entry {
    std::optional<Value> value;
    std::shared_ptr<const Listener> listener;  ///< shared: it may be replaced while it is called
  };
  struct News {
    std::shared_ptr<const Listener> listener;
    const std::uint16_t* registers;
  };
  /// Whether it is another value.
  static bool keep(Entry& entry, const Point& point, const std::uint16_t* registers, host::Time at);

  const Map& map_;
  mutable std::mutex mutex_;
  mutable std::condition_variable came_;
  std::vector<Entry> entries_;
};

}  // namespace coupler::client
