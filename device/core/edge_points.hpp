// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "device/core/edges.hpp"
#include "device/core/image.hpp"
#include "device/core/statistics.hpp"

namespace coupler::node {

/// Counters and latched points: what edges of inputs do to the image, and what a master's write may do to
/// these points.
class EdgePoints final : public EdgeSink {
 public:
  /// All of them outlive it.
  EdgePoints(const Map& map, Image& image, Statistics& statistics)
      : map_(map), image_(image), statistics_(statistics) {}

  /// Counters of the input go up, in their own width and order, and wrap; its latches are set.
  void add(std::uint16_t input, const Edges& edges) override;

  /// Whether these holding registers hold no counter's value in part.
  bool holds_whole_counters(modbus::Range written) const;

  /// A write clears a latch with 0; a 1 leaves it as it is. `now` are the cells of the range, `next` what a
  /// master wants to write there: it becomes what is to be stored.
  void keep_latches(Table table, modbus::Range written, Span<const std::uint16_t> now,
                    Span<std::uint16_t> next) const;

 private:
  void count(const Point& point, std::uint32_t edges);
  void latch(const Point& point);

  const Map& map_;
  Image& image_;
  Statistics& statistics_;
};

}  // namespace coupler::node
