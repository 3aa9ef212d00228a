// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <deque>
#include <optional>

#include "coupler/host/core/clock.hpp"
#include "coupler/map/map.hpp"

namespace coupler::host {

/// Until a deadman value that the device would not carry out is written again.
constexpr auto deadman_retry = std::chrono::seconds(1);

/// The deadmen of the points that have one. The first message arms a deadman, and so does the first message
/// after it has expired.
class Deadmen {
 public:
  /// The storage of `map` must outlive the object.
  explicit Deadmen(const Map& map);

  /// Notes a message for the point. Any thread may call it. Returns true if the message armed the deadman, so
  /// that there is a new deadline to wait for.
  bool fed(std::uint32_t point, Time now);
  /// The earliest deadline; Time::max() if none is armed.
  Time due() const;
  struct Expired {
    std::uint32_t point;
    bool again;  ///< it has expired before, since the last message
  };
  /// Returns a point whose deadline has passed. Its deadman is disarmed, and its value has to be written.
  std::optional<Expired> take_expired(Time now);
  /// Undoes take_expired(): nothing was written.
  void put_back(const Expired& expired);
  /// Notes that the value could not be written. It is tried again from `when` on, unless a message comes
  /// first.
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
