// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "coupler/map/owned_map.hpp"

namespace coupler::fakes {

codec::Format half(codec::Type type, codec::Half half);

/// A map without a file:
///   MapBuilder().coil("valve", 0).holding("level", 3, codec::Type::REAL).build()
class MapBuilder {
 public:
  explicit MapBuilder(std::string_view name = "device");
  MapBuilder(const MapBuilder&);
  MapBuilder(MapBuilder&&) noexcept;
  MapBuilder& operator=(const MapBuilder&);
  MapBuilder& operator=(MapBuilder&&) noexcept;
  ~MapBuilder();

  /// A point; what the table's default does not give is set in `adjust`.
  template <class Adjust>
  MapBuilder& add(Table table, std::string_view name, std::uint16_t address, codec::Type type,
                  Adjust adjust) {
    adjust(point(table, name, address, type));
    return *this;
  }
  MapBuilder& add(Table table, std::string_view name, std::uint16_t address, codec::Type type) {
    point(table, name, address, type);
    return *this;
  }

  MapBuilder& coil(std::string_view name, std::uint16_t address);
  /// A coil that cannot be read.
  MapBuilder& command(std::string_view name, std::uint16_t address);
  MapBuilder& input(std::string_view name, std::uint16_t address);
  MapBuilder& input_register(std::string_view name, std::uint16_t address,
                             codec::Type type = codec::Type::UINT);
  MapBuilder& holding(std::string_view name, std::uint16_t address, codec::Type type = codec::Type::UINT);
  MapBuilder& holding(std::string_view name, std::uint16_t address, codec::Format format);

  /// `count` points of one address each: BOOL in the bit tables, WORD in the others. Named by table and
  /// address.
  MapBuilder& many(Table table, unsigned from, unsigned count);

  MapBuilder& wire(const std::string& from, const std::string& to, bool invert = false);
  MapBuilder& square(const std::string& to, std::chrono::microseconds period);
  MapBuilder& text(std::string text);
  MapBuilder& unit(std::uint8_t unit);
  MapBuilder& watchdog(Watchdog watchdog);
  /// `security` with one role, everybody's, who may read and write the points of these names.
  MapBuilder& everybody_may(std::vector<std::string> read, std::vector<std::string> write);
  /// What no function here sets.
  Map& head() { return head_; }
  /// Registers that a point's `initial` can view.
  Span<const std::uint16_t> keep(std::vector<std::uint16_t> registers);

  /// May be called again: each map is its own.
  MapPtr build() const;

 private:
  Point& point(Table table, std::string_view name, std::uint16_t address, codec::Type type);

  std::shared_ptr<OwnedMap> owned_;
  Map head_;
  std::vector<Point> points_;
  std::vector<SimWire> wires_;
  bool is_limited_ = false;
  std::vector<std::string> readable_;
  std::vector<std::string> writable_;
};

}  // namespace coupler::fakes
