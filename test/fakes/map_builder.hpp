// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "common/map/owned_map.hpp"

namespace coupler::fakes {

/// A map without a file:
///   MapBuilder().bits(Table::coils, 0, 8).add(Table::holding_registers, "level", 3,
///   codec::Type::REAL).build()
class MapBuilder {
 public:
  explicit MapBuilder(std::string_view name = "device") { head_.name = owned_->keep(std::string(name)); }

  /// A point; what the table's default does not give is set in `adjust`.
  template <class Adjust>
  MapBuilder& add(Table table, const std::string& name, std::uint16_t address, codec::Type type,
                  Adjust adjust) {
    Point point;
    point.name = owned_->keep(name);
    point.table = table;
    point.address = address;
    point.format.type = type;
    point.access = is_writable(table) ? Access::read_write : Access::read;
    adjust(point);
    points_.push_back(point);
    return *this;
  }
  MapBuilder& add(Table table, const std::string& name, std::uint16_t address, codec::Type type) {
    return add(table, name, address, type, [](Point&) {});
  }

  /// `count` points of one address each: BOOL in the bit tables, WORD in the others. Named by table and
  /// address.
  MapBuilder& many(Table table, unsigned from, unsigned count) {
    const auto type = holds_bits(table) ? codec::Type::BOOL : codec::Type::WORD;
    for (unsigned address = from; address < from + count; ++address)
      add(table, std::string(to_string(table)) + "_" + std::to_string(address),
          static_cast<std::uint16_t>(address), type);
    return *this;
  }

  MapBuilder& wire(const std::string& from, const std::string& to, bool invert = false) {
    wires_.push_back({owned_->keep(from), owned_->keep(to), invert, {}});
    return *this;
  }
  MapBuilder& square(const std::string& to, std::chrono::microseconds period) {
    wires_.push_back({{}, owned_->keep(to), false, period});
    return *this;
  }
  MapBuilder& text(std::string text) {
    head_.text = owned_->keep(std::move(text));
    return *this;
  }
  MapBuilder& unit(std::uint8_t unit) {
    head_.connection.unit = unit;
    return *this;
  }
  MapBuilder& watchdog(Watchdog watchdog) {
    head_.service.watchdog = watchdog;
    return *this;
  }
  /// What no function here sets.
  Map& head() { return head_; }
  /// Registers that a point's `initial` can view.
  Span<const std::uint16_t> keep(std::vector<std::uint16_t> registers) {
    return owned_->keep(std::move(registers));
  }

  MapPtr build() {
    owned_->finish(head_, points_, wires_);
    return owned_;
  }

 private:
  std::shared_ptr<OwnedMap> owned_ = std::make_shared<OwnedMap>();
  Map head_;
  std::vector<Point> points_;
  std::vector<SimWire> wires_;
};

}  // namespace coupler::fakes
