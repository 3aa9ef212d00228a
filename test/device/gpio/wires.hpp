// SPDX-License-Identifier: Apache-2.0
// What tests of a map's lines share: a node on the chips of fake_backend.hpp.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "coupler/device/gpio/line_requests.hpp"
#include "test/device/core/fake_log.hpp"
#include "test/device/gpio/fake_backend.hpp"
#include "test/fakes/map_builder.hpp"

namespace coupler::device {

inline auto at(unsigned offset, Safe safe = Safe::off, bool active_low = false) {
  return [=](Point& p) {
    p.line.chip = "plant";
    p.line.offset = offset;
    p.line.active_low = active_low;
    p.safe = safe;
  };
}

/// A node whose map is changed, or whose chip is unplugged.
class Wires : public testing::Test {
 protected:
  Wires() { machine = Machine(); }

  /// The error; empty: it is in force.
  std::string change_to(const fakes::MapBuilder& builder, bool safe = false) {
    const MapPtr map = builder.build();
    auto next = LineRequests::prepare(map->map(), wiring(), safe, log_);
    if (!next) return next.error();
    machine.history.push_back("prepared");
    auto taken = (*next)->take_over();
    owner_ = map;
    wiring_ = std::move(taken);
    return "";
  }
  LineRequests* wiring() { return static_cast<LineRequests*>(wiring_.get()); }
  bool write(std::uint16_t coil, std::uint16_t level) {
    return wiring_->lines().drive(modbus::Range::of(coil, 1), Span<const std::uint16_t>(&level, 1));
  }
  std::vector<std::string> news() { return std::exchange(machine.history, {}); }
  /// Returns what can be plugged in again.
  static std::vector<Chip> unplug() {
    machine.gone = {"gpiochip0"};
    return std::exchange(machine.chips, {});
  }
  static void plug(std::vector<Chip> chips) {
    machine.chips = std::move(chips);
    machine.gone.clear();
  }

  static fakes::MapBuilder two_lamps() {
    return fakes::MapBuilder()
        .add(Table::coils, "a", 0, codec::Type::BOOL, at(0))
        .add(Table::coils, "b", 1, codec::Type::BOOL, at(1, Safe::on));
  }

  FakeLog log_;
  MapPtr owner_;
  std::unique_ptr<Wiring> wiring_;
};

}  // namespace coupler::device
