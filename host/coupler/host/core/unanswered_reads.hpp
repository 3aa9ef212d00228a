// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <vector>

#include "coupler/host/core/clock.hpp"
#include "coupler/map/map.hpp"
#include "coupler/plan/read_span.hpp"

namespace coupler::host {

/// Read requests that ended a connection although others were answered before and after: many devices refuse
/// an address by silence, or by a malformed reply. Such a request is parted like one that is refused. What is
/// left of it is set aside and tried again after 10 s, then after twice as long each time, up to 10 minutes.
/// The list outlives connections, since each new one would be ended again.
class UnansweredReads {
 public:
  /// Notes that the request has ended a connection, perhaps by chance.
  void suspect(const plan::ReadSpan& span);
  /// Returns whether the request, or one that contained it, ended the connection when it was sent last, so
  /// that another end is not chance.
  bool is_suspected(const plan::ReadSpan& span) const;
  /// Notes that the request has ended a connection again. From now on a part of it need not be suspected
  /// first.
  void convict(const plan::ReadSpan& span);
  /// Sets aside what is left of the request once it is parted: points that one request reads.
  void add(const plan::ReadSpan& span, Time now);
  /// Notes that a request that was tried again has ended a connection once more. Returns false if it was not
  /// set aside.
  bool failed_again(const plan::ReadSpan& span, Time now);
  /// Notes that the request was answered. Returns true if it had been set aside.
  bool answered(const plan::ReadSpan& span);

  /// Returns whether the request is set aside, also while it is being tried again.
  bool has(const plan::ReadSpan& span) const;
  /// The time at which something is to be tried again; Time::max() if nothing is.
  Time due() const;
  /// Returns the points that are to be tried again now, once until the outcome is known.
  std::vector<std::uint32_t> take_due(Time now);
  /// Returns all points that are set aside, also those that are being tried again. A new connection begins
  /// without them.
  std::vector<std::uint32_t> take_back();
  /// The ranges that no request for several points may contain.
  const std::vector<TableRange>& ranges() const { return guilty_; }

 private:
  static constexpr Duration shortest = std::chrono::seconds(10);
  static constexpr Duration longest = std::chrono::minutes(10);

  struct Entry {
    TableRange place;
    std::vector<std::uint32_t> points;
    Duration pause;
    Time again;
    bool is_tried = false;
  };
  std::vector<Entry>::iterator find(const plan::ReadSpan& span);

  std::vector<TableRange> suspects_;  ///< requests that ended the connection when they were sent last
  std::vector<TableRange> guilty_;
  std::vector<Entry> entries_;
};

}  // namespace coupler::host
