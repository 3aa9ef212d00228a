// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "coupler/host/core/stamp.hpp"
#include "coupler/map/map.hpp"

namespace coupler::host {

/// The last 8192 changes of a device's values, for who asks later what has happened since a time. It keeps
/// points of at most most_registers host_registers(), and not long texts and arrays.
class ChangeHistory {
 public:
  static constexpr std::size_t most_changes = 8192;
  static constexpr std::size_t most_registers = 5;  ///< a number of 64 bits and its exponent
  using Registers = std::array<std::uint16_t, most_registers>;

  struct Change {
    std::uint32_t point = 0;
    bool has_before = false;  ///< otherwise nothing was known of the value before
    Registers before{};
    Stamp before_until;  ///< when the value was last known to be `before`
    Registers now{};
    Stamp stamp;  ///< when the value was known to be `now`
  };

  /// It begins now. The storage of `map` must outlive it.
  ChangeHistory(const Map& map, Time now) : map_(map), last_(map.points.size()), forgotten_(now) {}

  bool keeps(std::uint32_t point) const;
  /// The point had the value in these host_registers() at the time of the stamp. `is_told`: the device has
  /// announced it, so that the value was the one before until then.
  void see(std::uint32_t point, const Stamp& stamp, const std::uint16_t* registers, bool is_told);
  /// Nothing is known of the point between its last value and the next one.
  void lose(std::uint32_t point) { last_[point].known = false; }
  /// The same for all points.
  void lose_all();

  /// The last value of a point that it keeps; null if nothing is known of it.
  const std::uint16_t* last(std::uint32_t point) const {
    return last_[point].known ? last_[point].registers.data() : nullptr;
  }
  /// Returns whether it has all changes since the time.
  bool reaches(Time since) const { return since > forgotten_; }
  /// Calls see(change) for each change of the point that may have been at `since` or later, oldest first.
  void each_since(std::uint32_t point, Time since, const std::function<void(const Change&)>& see) const;

 private:
  struct Last {
    Registers registers{};
    Stamp stamp{};
    bool known = false;
  };
  void keep(const Change& change);

  const Map map_;
  std::vector<Last> last_;       ///< by point
  std::vector<Change> changes_;  ///< a ring, once it has most_changes
  std::size_t oldest_ = 0;
  Time forgotten_;  ///< of what happened until then something is missing
};

}  // namespace coupler::host
