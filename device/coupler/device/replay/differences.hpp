// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include "coupler/device/replay/recording.hpp"

namespace coupler::device {

/// Compares what clients write to outputs with what was recorded of them: each change of the one has to be
/// there in the other, to the same value, at most a tolerance apart. Times are those of the recording.
class Differences {
 public:
  struct Difference {
    Nanoseconds at{};
    std::uint32_t point = 0;
    std::string what;
  };
  /// `tolerance`: of each; 0: two periods of the point. `wanted`: by point, whether its differences count.
  /// The recording outlives it.
  Differences(const Recording& recording, Nanoseconds tolerance, const std::vector<bool>& wanted);

  /// The recording has changed a point.
  void recorded(std::uint32_t point, const std::uint16_t* registers, Nanoseconds at);
  /// A client has written it. From its first write on the point is compared.
  void written(std::uint32_t point, const std::uint16_t* registers, Nanoseconds at);
  bool is_written(std::uint32_t point) const { return outputs_[point].is_written; }
  /// Those that are certain at this time.
  std::vector<Difference> take(Nanoseconds now);
  /// The recording has ended: what has no partner yet has none.
  std::vector<Difference> take_all();
  /// It is played from its beginning, after take_all(): the way back there is no change.
  void begin_again();
  /// Until when a change may still get its partner; 0: none is without.
  Nanoseconds open_until() const;
  /// Points that have changed in the recording, and that no client has written.
  std::vector<std::uint32_t> unwritten() const;

 private:
  using Registers = std::vector<std::uint16_t>;
  struct Change {
    Nanoseconds at;
    Registers registers;
    bool is_before = false;  ///< the first write: may be a partner, but needs none
  };
  struct Output {
    bool is_wanted = false;
    bool is_written = false;   ///< by a client
    bool has_changed = false;  ///< in the recording
    Registers recorded;        ///< the last value
    Registers written;
    std::deque<Change> recorded_alone;  ///< changes without a partner yet
    std::deque<Change> written_alone;
  };
  bool are_equal(std::uint32_t point, const Registers& a, const Registers& b) const;
  Nanoseconds tolerance(std::uint32_t point) const;
  void change(std::uint32_t point, Change change, std::deque<Change>& own, std::deque<Change>& others);
  std::vector<Difference> take_before(Nanoseconds time);

  const Recording& recording_;
  Nanoseconds tolerance_;
  std::vector<Output> outputs_;
};

}  // namespace coupler::device
