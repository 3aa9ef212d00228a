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

/// How many changes a NodeCore keeps for clients that wait for them, 24 bytes each: those of two replies and
/// some more.
constexpr std::size_t kept_changes = 48;

/// The part that the generated coupler::maps::NAME::NodeCore of every map has in common: a node in static
/// memory, for microcontrollers. `Areas`, `Cells`, `Bits`, `Links` and `Pulses` are the map's NodeMemory.
/// `Scheduled` is the number of outputs that clients can schedule. One task makes all calls: requests,
/// tick(), and the values that the firmware sets. It uses no heap, no exceptions and no threads.
template <std::size_t Areas, std::size_t Cells, std::size_t Bits, std::size_t Links, std::size_t Pulses = 0,
          std::size_t KeptChanges = kept_changes, std::size_t Scheduled = 4>
class NodeCore : public Hooks {
 public:
  NodeCore(const NodeCore&) = delete;
  NodeCore& operator=(const NodeCore&) = delete;

  /// Answers the requests that the port has received.
  Server& server() { return server_; }
  /// Its tick() is called when time_until_due() has passed. Clients can wait for changes once the port has
  /// called its tell_changes(); then it also calls the server's answer_waiting().
  Handler& handler() { return handler_; }
  /// The counts of the port: connections, refusals, evictions, bad_frames, timeouts.
  Statistics& statistics() { return statistics_; }
  const OutputWatchdog& watchdog() const { return watchdog_; }

  void put_new_values(Image&, Changes& changes) final {
    if (std::exchange(bits_were_set_, false)) changes.compare_all();  // set() has put them there
  }
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
        changes_(image_, ring_, told_),
        schedule_(scheduled_, &changes_, Pulses),
        handler_(map, {lines, analogue_ ? &*analogue_ : nullptr, &hooked_},
                 {image_, statistics_, watchdog_, links_, changes_, schedule_}),
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
    bits_were_set_ |= holds_bits(to.table);
    return PlainValue<T>::encode(value, to, image_.find(to.table, range(to)).data());
  }

 private:
  const Map& map_;
  std::array<Image::Area, Areas> areas_{};
  std::array<std::uint16_t, Cells> cells_{};
  std::array<EdgePoints::Link, Links> links_{};
  std::array<ChangeRing::Entry, KeptChanges> ring_{};
  std::array<std::uint16_t, Bits> told_{};
  bool bits_were_set_ = false;  ///< since put_new_values()
  Image image_;
  HookedPoints hooked_;
  std::optional<AnaloguePoints> analogue_;
  Statistics statistics_;
  OutputWatchdog watchdog_;
  Changes changes_;
  std::array<ScheduledOutput, Scheduled + Pulses> scheduled_{};
  OutputSchedule schedule_;
  Handler handler_;
  Server server_;
};

}  // namespace coupler::device
