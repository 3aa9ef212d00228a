// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bitset>
#include <cstdint>

#include "coupler/device/core/hardware.hpp"
#include "coupler/device/core/output_schedule.hpp"

namespace coupler::device {

/// The end of what was driven for a duration: outputs go back to the values from before it, each for itself;
/// those with a pulse, and at the end of one, to 0.
/// What another duration that began later has driven since goes back at the end of that one. Latches and
/// counters stay as they are, and so does what is in its safe state since, if that is not `hold`. What was to
/// go there and could not goes there.
class TimedOutputEnd {
 public:
  /// All of them outlive it. `next` has at least modbus::max_scheduled_bits elements, for its own use.
  TimedOutputEnd(const Map& map, Image& image, Hardware& hardware, OutputSchedule& schedule,
                 Span<std::uint16_t> next)
      : map_(map), image_(image), hardware_(hardware), schedule_(schedule), next_(next) {}

  /// True: it is over, and its place is free. False: an output cannot be driven; it is due again after this
  /// time.
  static constexpr std::chrono::milliseconds retry_period{100};
  bool of(ScheduledOutput& which, TimePoint now);
  /// Tries to end all outputs that have begun. Returns whether all are over.
  bool of_all(TimePoint now);

 private:
  bool goes_back(const Point& point, const ScheduledOutput& which) const;
  void put(const Point& point, ScheduledOutput& which);
  bool drive(const ScheduledOutput& which, Span<std::uint16_t> cells);

  const Map& map_;
  Image& image_;
  Hardware& hardware_;
  OutputSchedule& schedule_;
  Span<std::uint16_t> next_;                      ///< from the beginning of the range on
  std::bitset<modbus::max_scheduled_bits> back_;  ///< what of it is to be driven
};

}  // namespace coupler::device
