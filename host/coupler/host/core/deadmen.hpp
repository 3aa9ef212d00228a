// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <deque>
#include <optional>

#include "coupler/host/core/clock.hpp"
#include "coupler/map/map.hpp"

namespace coupler::host {

/// The deadman of each point that has one. It is armed by the first message, and again by the first one after
/// it has expired.
class Deadmen {
 public:
  /// What `map` views must outlive it.
  explicit Deadmen(const Map& map);

  /// A message has come for the point. From any thread. True if that armed it: there is a new deadline to
  /// wait for.
  bool fed(std::uint32_t point, Time now);
  /// The earliest deadline; Time::max() if none is armed.
  Time due() const;
  struct Expired {
    std::uint32_t point;
    bool again;  ///< it was before, since the last message
  };
  /// A point whose deadline has passed: it is disarmed, and its value is to be written.
  std::optional<Expired> take_expired(Time now);
  /// Nothing has been done about it yet.
  void put_back(const Expired& expired);
  /// The value could not be written: it is to be tried again from `when` on, unless a message comes first.
  void retry(std::uint32_t point, Time when);

 private:
  static constexpr Time::rep disarmed = Time::max().time_since_epoch().count();
  struct Entry {
    std::uint32_t point;
    Duration timeout;
    std::atomic<Time::rep> deadline{disarmed};
    std::atomic<bool> again{false};
  };
  Entry* find(std::uint32_t point);

  std::deque<Entry> entries_;
};

}  // namespace coupler::host
