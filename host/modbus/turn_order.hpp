// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <vector>

namespace coupler::driver {

/// Who of those that wait for a turn is the next: writes before reads, each in the order in which they came.
///
/// So that writes cannot keep reads waiting for ever, each writes once at most between two reads: whoever has
/// written since the last read lets the longest waiting read go first. Without a read that waits, nobody
/// holds back.
class TurnOrder {
 public:
  using Who = const void*;
  enum class Rank { write, read };

  /// `who` waits now, for one turn at a time: at the end, or at the place that was kept.
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
    const auto place = place_of(who);
    place->waits = false;
    if (place->rank == Rank::write) places_.erase(place);
  }
  /// Null if nobody waits.
  Who next() const {
    const Place* read = nullptr;
    const Place* write = nullptr;
    for (const Place& place : places_) {
      if (!place.waits) continue;
      if (place.rank == Rank::write && !has_written(place.who)) return place.who;
      const Place*& first = place.rank == Rank::read ? read : write;
      if (first == nullptr) first = &place;
    }
    const Place* const next = read != nullptr ? read : write;
    return next != nullptr ? next->who : nullptr;
  }
  /// `who`, who waits, gets the turn.
  void serve(Who who) {
    const auto place = place_of(who);
    if (place->rank == Rank::read)
      wrote_.clear();
    else if (!has_written(who))
      wrote_.push_back(who);
    places_.erase(place);
  }

 private:
  struct Place {
    Who who;
    Rank rank;
    bool waits;
  };

  std::vector<Place>::iterator place_of(Who who) {
    return std::find_if(places_.begin(), places_.end(),
                        [&](const Place& place) { return place.waits && place.who == who; });
  }
  bool has_written(Who who) const { return std::find(wrote_.begin(), wrote_.end(), who) != wrote_.end(); }

  std::vector<Place> places_;  ///< in the order of coming
  std::vector<Who> wrote_;     ///< since the last read
};

}  // namespace coupler::driver
