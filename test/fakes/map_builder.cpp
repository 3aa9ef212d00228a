// SPDX-License-Identifier: Apache-2.0
#include "test/fakes/map_builder.hpp"

#include <algorithm>
#include <utility>

#include "coupler/map/fingerprint.hpp"

namespace coupler::fakes {

codec::Format half(codec::Type type, codec::Half half) {
  codec::Format format;
  format.type = type;
  format.half = half;
  return format;
}

MapBuilder::MapBuilder(std::string_view name) : owned_(std::make_shared<OwnedMap>()) {
  head_.name = owned_->keep(std::string(name));
}
MapBuilder::MapBuilder(const MapBuilder&) = default;
MapBuilder::MapBuilder(MapBuilder&&) noexcept = default;
MapBuilder& MapBuilder::operator=(const MapBuilder&) = default;
MapBuilder& MapBuilder::operator=(MapBuilder&&) noexcept = default;
MapBuilder::~MapBuilder() = default;

Point& MapBuilder::point(Table table, std::string_view name, std::uint16_t address, codec::Type type) {
  Point& point = points_.emplace_back();
  point.name = owned_->keep(std::string(name));
  point.table = table;
  point.address = address;
  point.format.type = type;
  point.access = is_writable(table) ? Access::read_write : Access::read;
  return point;
}

MapBuilder& MapBuilder::coil(std::string_view name, std::uint16_t address) {
  return add(Table::coils, name, address, codec::Type::BOOL);
}

MapBuilder& MapBuilder::command(std::string_view name, std::uint16_t address) {
  return add(Table::coils, name, address, codec::Type::BOOL,
             [](Point& point) { point.access = Access::write; });
}

MapBuilder& MapBuilder::input(std::string_view name, std::uint16_t address) {
  return add(Table::discrete_inputs, name, address, codec::Type::BOOL);
}

MapBuilder& MapBuilder::input_register(std::string_view name, std::uint16_t address, codec::Type type) {
  return add(Table::input_registers, name, address, type);
}

MapBuilder& MapBuilder::holding(std::string_view name, std::uint16_t address, codec::Type type) {
  return add(Table::holding_registers, name, address, type);
}

MapBuilder& MapBuilder::holding(std::string_view name, std::uint16_t address, codec::Format format) {
  return add(Table::holding_registers, name, address, format.type,
             [&](Point& point) { point.format = format; });
}

MapBuilder& MapBuilder::many(Table table, unsigned from, unsigned count) {
  const auto type = holds_bits(table) ? codec::Type::BOOL : codec::Type::WORD;
  for (unsigned address = from; address < from + count; ++address)
    add(table, std::string(to_string(table)) + "_" + std::to_string(address),
        static_cast<std::uint16_t>(address), type);
  return *this;
}

MapBuilder& MapBuilder::wire(const std::string& from, const std::string& to, bool invert) {
  wires_.push_back({owned_->keep(from), owned_->keep(to), invert, {}});
  return *this;
}

MapBuilder& MapBuilder::square(const std::string& to, std::chrono::microseconds period) {
  wires_.push_back({{}, owned_->keep(to), false, period});
  return *this;
}

MapBuilder& MapBuilder::text(std::string text) {
  head_.text = owned_->keep(text);
  return *this;
}

MapBuilder& MapBuilder::unit(std::uint8_t unit) {
  head_.connection.unit = unit;
  return *this;
}

MapBuilder& MapBuilder::watchdog(Watchdog watchdog) {
  head_.service.watchdog = watchdog;
  return *this;
}

Span<const std::uint16_t> MapBuilder::keep(std::vector<std::uint16_t> registers) {
  return owned_->keep(registers);
}

MapBuilder& MapBuilder::everybody_may(std::vector<std::string> read, std::vector<std::string> write) {
  is_limited_ = true;
  readable_ = std::move(read);
  writable_ = std::move(write);
  return *this;
}

MapPtr MapBuilder::build() const {
  struct Built {
    OwnedMap map;
    std::shared_ptr<OwnedMap> texts;
  };
  const auto built = std::make_shared<Built>();
  built->texts = owned_;
  Map head = head_;
  if (is_limited_) {
    std::vector<Point> points = points_;
    std::sort(points.begin(), points.end(), canonical_less);
    std::vector<std::uint8_t> rights;
    const auto names = [](const std::vector<std::string>& list, std::string_view name) {
      return std::find(list.begin(), list.end(), name) != list.end();
    };
    for (const Point& point : points)
      rights.push_back(static_cast<std::uint8_t>((names(readable_, point.name) ? 1 : 0) |
                                                 (names(writable_, point.name) ? 2 : 0)));
    const bool reads_all =
        std::all_of(rights.begin(), rights.end(), [](auto right) { return (right & 1) != 0; });
    head.security = {built->map.keep(std::vector<Role>{{"everybody", built->map.keep(rights), reads_all}}),
                     std::uint16_t{0}};
  }
  built->map.finish(head, points_, wires_);
  return {built, &built->map};
}

}  // namespace coupler::fakes
