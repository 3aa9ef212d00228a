// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/replay/played_map.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include <fmt/format.h>

namespace coupler::device {
namespace {

class Builder {
 public:
  explicit Builder(const Recording& recording)
      : recording_(recording),
        map_(recording.map()->map()),
        points_(map_.points.begin(), map_.points.end()) {}

  PlayedMap build() {
    for (Point& point : points_) {
      take_hardware_away(point);
      const auto read_at = std::exchange(point.read_address, std::nullopt);
      readbacks_.push_back(read_at && *read_at != point.address ? read_at : std::nullopt);
    }
    set_initial_values();
    add_readbacks();
    add_watchdog();
    PlayedMap played;
    played.owner = owner_;
    owner_->finish(map_, points_, {});
    played.map = owner_->map();
    played.map.fingerprint = map_.fingerprint;
    for (std::size_t i = 0; i < map_.points.size(); ++i) {
      played.index.push_back(index_of(played.map, map_.points[i].name));
      played.mirror.push_back(readback_names_[i].empty()
                                  ? std::nullopt
                                  : std::optional(index_of(played.map, readback_names_[i])));
    }
    return played;
  }

 private:
  static void take_hardware_away(Point& point) {
    point.line = {};
    point.counter = {};
    point.latched = {};
    point.iio = {};
    point.pwm = {};
    point.pulse = {};
  }

  static std::uint32_t index_of(const Map& map, std::string_view name) {
    return static_cast<std::uint32_t>(find(map, name) - map.points.begin());
  }

  void set_initial_values() {
    std::vector<bool> is_set(points_.size());
    for (const Recording::Event& event : recording_.events()) {
      if (event.kind != Recording::Event::Kind::value || is_set[event.point]) continue;
      is_set[event.point] = true;
      const std::uint16_t* const registers = recording_.registers(event);
      Point& point = points_[event.point];
      point.initial = owner_->keep(std::vector<std::uint16_t>(registers, registers + range(point).count()));
    }
  }

  bool is_free(Table table, modbus::Range wanted) const {
    return std::none_of(points_.begin(), points_.end(), [&](const Point& point) {
      return point.table == table && range(point).overlaps(wanted);
    });
  }

  std::string_view free_name(const std::string& stem) {
    std::string name = stem;
    while (
        std::any_of(points_.begin(), points_.end(), [&](const Point& point) { return point.name == name; }))
      name += '_';
    return owner_->keep(name);
  }

  void add_readbacks() {
    readback_names_.resize(readbacks_.size());
    for (std::size_t i = 0; i < readbacks_.size(); ++i) {
      if (!readbacks_[i]) continue;
      Point point = points_[i];
      point.address = *readbacks_[i];
      if (!is_free(point.table, range(point)) && !is_partial(point)) continue;  // another point reads it, too
      point.name = free_name(fmt::format("{}_reads_back", point.name));
      point.access = Access::read;
      readback_names_[i] = point.name;
      points_.push_back(point);
    }
  }

  void add_watchdog() {
    const WatchdogSequences& watchdog = map_.coupler_watchdog;
    for (const auto& sequence : {watchdog.arm, watchdog.feed, watchdog.reset})
      for (const WatchdogSequences::Write& write : sequence) add_register(write);
    if (watchdog.alarm) add_register(*watchdog.alarm);
  }

  void add_register(const WatchdogSequences::Write& write) {
    if (!is_free(write.table, modbus::Range::of(write.address, 1))) return;
    Point point;
    point.name = free_name(fmt::format("watchdog_{}_{}", to_string(write.table), write.address));
    point.table = write.table;
    point.address = write.address;
    point.format.type = holds_bits(write.table) ? codec::Type::BOOL : codec::Type::WORD;
    point.access = is_writable(write.table) ? Access::read_write : Access::read;
    points_.push_back(point);
  }

  const Recording& recording_;
  const Map& map_;
  std::shared_ptr<OwnedMap> owner_ = OwnedMap::make();
  std::vector<Point> points_;
  std::vector<std::optional<std::uint16_t>> readbacks_;  ///< by point: the address
  std::vector<std::string_view> readback_names_;         ///< empty: it has none
};

}  // namespace

PlayedMap map_to_play(const Recording& recording) { return Builder(recording).build(); }

}  // namespace coupler::device
