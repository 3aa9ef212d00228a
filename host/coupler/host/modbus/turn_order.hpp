// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <vector>

#include "coupler/host/core/transport.hpp"

namespace coupler::host {

/// Who of those that wait for a turn is the next: writes before reads, each in the order in which they came.
/// While somebody claims all turns, nobody else gets one, also between two of his requests.
///
/// So that writes cannot keep reads waiting for ever, each writes once at most between two reads: whoever has
/// written since the last read lets the longest waiting read go first. Without a read that waits, nobody
/// holds back.
class TurnOrder {
 public:
  using Who = const void*;
  /// `who` waits now, for a read or a write or, after two calls, for whichever comes first: at the end, or at
  /// the place that was kept.
  void come(Who who, Rank rank) {
    const auto kept = std::find_if(places_.begin(), places_.end(), [&](const Place& place) {
      return place.who == who && place.rank == rank;
    });
    if (kept != places_.end())
      kept->waits = true;
    else
      places_.push_back({who, rank, true});
  }
  /// `who` does not wait any longer. The place of a read is kept: it comes again.
  void leave(Who who) {
    for (auto place = places_.begin(); place != places_.end();) {
      if (place->who == who) place->waits = false;
      place = place->who == who && place->rank != Rank::read ? places_.erase(place) : place + 1;
    }
  }
  /// From now on all turns are for `who`, and for others who have claimed them.
  void claim(Who who) {
    if (!claims(who)) claims_.push_back(who);
  }
  void give_up_claim(Who who) {
    claims_.erase(std::remove(claims_.begin(), claims_.end(), who), claims_.end());
  }
  /// Whether `who`, who does not wait, may have the turn.
  bool is_free_for(Who who) const { return next() == nullptr && (claims_.empty() || claims(who)); }
  /// Null if nobody waits, or somebody who claims all turns does not at the moment.
  Who next() const {
    const auto place = next_place();
    return place == places_.end() ? nullptr : place->who;
  }
  /// The next one gets the turn, for what is returned, and waits for nothing else.
  Rank serve() {
    const auto place = next_place();
    const auto [who, rank, waits] = *place;
    if (rank == Rank::read)
      wrote_.clear();
    else if (!has_written(who))
      wrote_.push_back(who);
    places_.erase(place);
    leave(who);
    return rank;
  }

 private:
  struct Place {
    Who who;
    Rank rank;
    bool waits;
  };

  using Places = std::vector<Place>;

  Places::const_iterator next_place() const {
    auto read = places_.end();
    auto write = places_.end();
    for (auto place = places_.begin(); place != places_.end(); ++place) {
      if (!place->waits || !(claims_.empty() || claims(place->who))) continue;
      if (place->rank != Rank::read && !(claims_.empty() && has_written(place->who))) return place;
      auto& first = place->rank == Rank::read ? read : write;
      if (first == places_.end()) first = place;
    }
    return read != places_.end() ? read : write;
  }
  bool claims(Who who) const { return std::find(claims_.begin(), claims_.end(), who) != claims_.end(); }
  bool has_written(Who who) const { return std::find(wrote_.begin(), wrote_.end(), who) != wrote_.end(); }

  Places places_;  ///< in the order of coming
  std::vector<Who> claims_;
  std::vector<Who> wrote_;  ///< since the last read
};

}  // namespace coupler::host
