// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>

#include "coupler/device/core/analogue_points.hpp"
#include "coupler/device/core/hooks.hpp"
#include "coupler/device/core/server.hpp"
#include "coupler/map/image_layout.hpp"
#include "coupler/map/plain_value.hpp"

namespace coupler::device {

/// What the generated coupler::maps::NAME::NodeCore of every map has in common: a node in static memory, for
/// microcontrollers. `Areas`, `Cells` and `Links` are the map's NodeMemory. All of it is called in one task:
/// requests, tick(), and what the firmware sets. No heap, no exceptions, no threads.
template <std::size_t Areas, std::size_t Cells, std::size_t Links>
class NodeCore : public Hooks {
 public:
  NodeCore(const NodeCore&) = delete;
  NodeCore& operator=(const NodeCore&) = delete;

  /// Answers the requests that the port has received.
  Server& server() { return server_; }
  /// Its tick() is called when time_until_due() has passed.
  Handler& handler() { return handler_; }
  /// What the port counts: connections, refusals, evictions, bad_frames, timeouts.
  Statistics& statistics() { return statistics_; }
  const OutputWatchdog& watchdog() const { return watchdog_; }

  void put_new_values(Image&) final {}  // set() has put them there
  [[nodiscard]] bool accept(std::uint32_t, const std::uint16_t*) override { return true; }

 protected:
  /// All of them outlive it. `channels` is null if no register of the map has one.
  NodeCore(const Map& map, Lines& lines, Channels* channels)
      : map_(map),
        image_(map, areas_, cells_),
        hooked_(map, image_, *this),
        analogue_(channels == nullptr ? std::nullopt
                                      : std::optional<AnaloguePoints>(std::in_place, map, image_, *channels)),
        watchdog_(map.service.watchdog),
        handler_(map, image_, {lines, analogue_ ? &*analogue_ : nullptr, &hooked_}, statistics_, watchdog_,
                 links_),
        server_(map.connection.unit, handler_, statistics_) {}
  ~NodeCore() = default;

  template <class T>
  T decode(std::uint32_t point, const std::uint16_t* registers) const {
    return PlainValue<T>::decode(registers, map_.points[point]);
  }

  /// Clients read the value from now on. False: the point cannot hold it.
  template <class T>
  bool set(std::uint32_t point, const T& value) {
    const Point& to = map_.points[point];
    return PlainValue<T>::encode(value, to, image_.find(to.table, range(to)).data());
  }

 private:
  const Map& map_;
  std::array<Image::Area, Areas> areas_{};
  std::array<std::uint16_t, Cells> cells_{};
  std::array<EdgePoints::Link, Links> links_{};
  Image image_;
  HookedPoints hooked_;
  std::optional<AnaloguePoints> analogue_;
  Statistics statistics_;
  OutputWatchdog watchdog_;
  Handler handler_;
  Server server_;
};

}  // namespace coupler::device
