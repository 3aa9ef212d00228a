// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "coupler/device/core/edge_points.hpp"
#include "coupler/device/core/image.hpp"
#include "coupler/device/core/output_schedule.hpp"
#include "coupler/device/core/statistics.hpp"
#include "coupler/device/core/watchdog.hpp"
#include "coupler/device/supervisor/shared_memory.hpp"
#include "coupler/map/identity.hpp"
#include "coupler/map/image_layout.hpp"

namespace coupler::device {

/// The state of a node for as long as its map stays the same: values, statistics, watchdog, scheduled
/// outputs. It is shared with forked processes, so a new worker process goes on where the one before ended.
class SharedState {
 public:
  /// Initial values. The map outlives it.
  SharedState(const Map& map, TimePoint now, const identity::Machine& machine = {});

  /// How many outputs clients can schedule.
  static constexpr std::size_t scheduled_outputs = 64;

  /// Finds out what take_over() from this other state, of another map, is to copy: that takes its time if
  /// there are many points.
  void prepare_take_over(const SharedState& before, bool has_field_side = false);
  /// Takes over from the other state what both have: statistics, the watchdog's state, and the value of
  /// every point that has the same name, table, type and layout in both; and scheduled outputs and pulses
  /// that have begun, if they fit().
  void take_over(const SharedState& before, TimePoint now);

  /// Returns whether an output of `before`, for which take_over() was prepared, belongs to the same points
  /// here, at the same addresses, with the same hardware behind them.
  bool fits(const ScheduledOutput& begun, const SharedState& before) const;

  Image& image() { return image_; }
  Statistics& statistics() { return lasting_[0].statistics; }
  OutputWatchdog& watchdog() { return lasting_[0].watchdog; }
  Span<EdgePoints::Link> links() { return links_; }
  Span<ScheduledOutput> scheduled() { return scheduled_.all(); }
  /// How many of these, the last ones, are for pulses.
  std::size_t pulses() const { return scheduled_.all().size() - scheduled_outputs; }
  const identity::Machine& machine() const { return machine_; }

 private:
  struct Lasting {
    Statistics statistics;
    OutputWatchdog watchdog;
  };
  /// Cells of a point in the other image and in this one.
  struct Carried {
    const Point* point;
    const Point* before;
    Span<const std::uint16_t> from;
    Span<std::uint16_t> to;
    std::uint16_t mask;
  };
  void take_over_schedule(const SharedState& before);
  SharedState(const Map& map, TimePoint now, NodeMemory size, const identity::Machine& machine);

  const Map& map_;
  std::vector<Image::Area> areas_;
  SharedArray<std::uint16_t> cells_;
  Image image_;
  SharedArray<Lasting> lasting_;
  SharedArray<ScheduledOutput> scheduled_;
  std::vector<EdgePoints::Link> links_;
  std::vector<Carried> carried_;
  identity::Machine machine_;
};

}  // namespace coupler::device
