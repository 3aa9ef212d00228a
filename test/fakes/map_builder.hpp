// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "common/map/owned_map.hpp"

namespace coupler::fakes {

inline codec::Format half(codec::Type type, codec::Half half) {
  codec::Format format;
  format.type = type;
  format.half = half;
  return format;
}

/// A map without a file:
///   MapBuilder().coil("valve", 0).holding("level", 3, codec::Type::REAL).build()
class MapBuilder {
 public:
  explicit MapBuilder(std::string_view name = "device") { head_.name = owned_->keep(std::string(name)); }

  /// A point; what the table's default does not give is set in `adjust`.
  template <class Adjust>
  MapBuilder& add(Table table, std::string_view name, std::uint16_t address, codec::Type type,
                  Adjust adjust) {
    Point point;
    point.name = owned_->keep(std::string(name));
    point.table = table;
    point.address = address;
    point.format.type = type;
    point.access = is_writable(table) ? Access::read_write : Access::read;
    adjust(point);
    points_.push_back(point);
    return *this;
  }
  MapBuilder& add(Table table, std::string_view name, std::uint16_t address, codec::Type type) {
    return add(table, name, address, type, [](Point&) {});
  }

  MapBuilder& coil(std::string_view name, std::uint16_t address) {
    return add(Table::coils, name, address, codec::Type::BOOL);
  }
  /// A coil that cannot be read.
  MapBuilder& command(std::string_view name, std::uint16_t address) {
    return add(Table::coils, name, address, codec::Type::BOOL,
               [](Point& point) { point.access = Access::write; });
  }
  MapBuilder& input(std::string_view name, std::uint16_t address) {
    return add(Table::discrete_inputs, name, address, codec::Type::BOOL);
  }
  MapBuilder& input_register(std::string_view name, std::uint16_t address,
                             codec::Type type = codec::Type::UINT) {
    return add(Table::input_registers, name, address, type);
  }
  MapBuilder& holding(std::string_view name, std::uint16_t address, codec::Type type = codec::Type::UINT) {
    return add(Table::holding_registers, name, address, type);
  }
  MapBuilder& holding(std::string_view name, std::uint16_t address, codec::Format format) {
    return add(Table::holding_registers, name, address, format.type,
               [&](Point& point) { point.format = format; });
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

  /// May be called again: each map is its own.
  MapPtr build() const {
    struct Built {
      OwnedMap map;
      std::shared_ptr<OwnedMap> texts;
    };
    const auto built = std::make_shared<Built>();
    built->texts = owned_;
    built->map.finish(head_, points_, wires_);
    return {built, &built->map};
  }

 private:
  std::shared_ptr<OwnedMap> owned_ = std::make_shared<OwnedMap>();
  Map head_;
  std::vector<Point> points_;
  std::vector<SimWire> wires_;
};

}  // namespace coupler::fakes
