// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "coupler/device/core/changes.hpp"
#include "coupler/device/core/edges.hpp"
#include "coupler/device/core/image.hpp"
#include "coupler/device/core/statistics.hpp"

namespace coupler::device {

/// Counters and latched points: what edges of inputs do to the image, and what a client's write may do to
/// these points. Each change of an input, and of such a bit, is told.
class EdgePoints final : public EdgeSink {
 public:
  /// One point that an edge of one input concerns.
  struct Link {
    std::uint16_t input = 0;
    Edge edge = Edge::rising;
    bool latches = false;  ///< otherwise it counts
    const Point* point = nullptr;
    std::uint16_t* cells = nullptr;  ///< the point's, in the image
  };
  /// All of them outlive it; `links` has node_memory().links elements (coupler/map/image_layout.hpp).
  EdgePoints(const Map& map, Image& image, Statistics& statistics, Span<Link> links, Changes& changes);

  /// Counters of the input go up, in their own width and order, and wrap; its latches are set.
  void add(std::uint16_t input, const Edges& edges) override;
  void changed(std::uint16_t input, bool level, TimePoint at) override {
    changes_.set_level(input, level, at);
  }
  void lost(std::uint32_t changes) override { changes_.lose(changes); }

  /// A write clears a latch with 0; a 1 leaves it as it is. `now` are the cells of the range, `next` what a
  /// client wants to write there: it becomes what is to be stored.
  void keep_latches(Table table, modbus::Range written, Span<const std::uint16_t> now,
                    Span<std::uint16_t> next) const;

 private:
  const Map& map_;
  Statistics& statistics_;
  Changes& changes_;
  Span<Link> links_;  ///< ascending inputs
};

}  // namespace coupler::device
