// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "common/map/owned_map.hpp"

namespace coupler::driver::test {

/// A map for a test, point by point. Names must be literals.
class MapBuilder {
 public:
  MapBuilder() {
    head_.name = "device";
    head_.text = "the map's text";
  }
  MapBuilder& coil(std::string_view name, std::uint16_t address) {
    return point(name, Table::coils, address, {}, Access::read_write);
  }
  MapBuilder& input(std::string_view name, std::uint16_t address) {
    return point(name, Table::discrete_inputs, address, {}, Access::read);
  }
  MapBuilder& input_register(std::string_view name, std::uint16_t address,
                             codec::Type type = codec::Type::UINT) {
    return point(name, Table::input_registers, address, format(type), Access::read);
  }
  MapBuilder& holding(std::string_view name, std::uint16_t address, codec::Type type = codec::Type::UINT) {
    return point(name, Table::holding_registers, address, format(type), Access::read_write);
  }
  MapBuilder& holding(std::string_view name, std::uint16_t address, codec::Format format) {
    return point(name, Table::holding_registers, address, format, Access::read_write);
  }
  MapBuilder& point(std::string_view name, Table table, std::uint16_t address, codec::Format format,
                    Access access) {
    Point point;
    point.name = name;
    point.table = table;
    point.address = address;
    point.format = format;
    point.access = access;
    points_.push_back(point);
    return *this;
  }
  Map& head() { return head_; }

  MapPtr build() const {
    auto owned = std::make_shared<OwnedMap>();
    owned->finish(head_, points_, {});
    return owned;
  }

  static codec::Format format(codec::Type type) {
    codec::Format result;
    result.type = type;
    return result;
  }
  static codec::Format half(codec::Type type, codec::Half half) {
    codec::Format result = format(type);
    result.half = half;
    return result;
  }

 private:
  Map head_;
  std::vector<Point> points_;
};

}  // namespace coupler::driver::test
