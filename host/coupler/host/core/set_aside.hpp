// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <vector>

#include "coupler/host/core/clock.hpp"
#include "coupler/map/map.hpp"
#include "coupler/plan/read_span.hpp"

namespace coupler::host {

/// Requests that ended a connection over which others were answered before and after: many devices refuse an
/// address by silence, or by a reply that is none. Such a request is parted like one that is refused; what is
/// left of it is set aside, and tried again after 10 s, then after twice as long each time, up to 10 minutes.
/// It outlives connections, since each of them would be ended again.
class SetAside {
 public:
  /// The request has ended a connection, perhaps by chance.
  void suspect(const plan::ReadSpan& span);
  /// If it ends a connection now, that is no chance: it did so when it was asked last, or is a part of one
  /// that did.
  bool is_suspected(const plan::ReadSpan& span) const;
  /// It has done so again. Neither it nor a part of it need be suspected first any more.
  void convict(const plan::ReadSpan& span);
  /// What is left of it once it is parted: points that one request reads.
  void add(const plan::ReadSpan& span, Time now);
  /// What had been tried again has ended a connection once more. False if the request is none of these.
  bool failed_again(const plan::ReadSpan& span, Time now);
  /// The request was answered. True if it had been set aside.
  bool answered(const plan::ReadSpan& span);

  /// The request is set aside, also while it is being tried.
  bool has(const plan::ReadSpan& span) const { return rests(span, Time::min()); }
  /// The request is set aside, and it is not its time.
  bool rests(const plan::ReadSpan& span, Time now) const;
  /// When something is to be tried again; Time::max(): never.
  Time due() const;
  /// The points that are to be tried again now: once, until the outcome is known.
  std::vector<std::uint32_t> take_due(Time now);
  /// All that are set aside, also those that are being tried: a new connection begins without them.
  std::vector<std::uint32_t> take_back();
  /// No request of several points may contain one of these.
  const std::vector<Unreadable>& ranges() const { return guilty_; }

 private:
  static constexpr Duration shortest = std::chrono::seconds(10);
  static constexpr Duration longest = std::chrono::minutes(10);

  struct Entry {
    Unreadable place;
    std::vector<std::uint32_t> points;
    Duration pause;
    Time again;
    bool is_tried = false;
  };
  std::vector<Entry>::iterator find(const plan::ReadSpan& span);

  std::vector<Unreadable> suspects_;  ///< they ended the connection when they were asked last
  std::vector<Unreadable> guilty_;
  std::vector<Entry> entries_;
};

}  // namespace coupler::host
