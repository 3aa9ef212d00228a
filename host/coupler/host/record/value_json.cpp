// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/record/value_json.hpp"

#include <cmath>
#include <cstdlib>
#include <variant>

#include <fmt/format.h>

#include "coupler/codec/value.hpp"
#include "coupler/host/core/value_text.hpp"

namespace coupler::host {
namespace {

using nlohmann::ordered_json;

/// A number of JSON can be neither infinite nor NaN; the text says which it was.
ordered_json number(double value) { return std::isfinite(value) ? ordered_json(value) : ordered_json(); }

/// 0.1 as REAL is 0.1, not 0.10000000149011612.
ordered_json number(float value) { return number(std::strtod(fmt::format("{}", value).c_str(), nullptr)); }

template <class T>
ordered_json number(const T& value) {
  return value;
}

/// The same: 217 x 0.1 is 21.7.
ordered_json scaled(const std::uint16_t* registers, Point point) {
  point.count = 1;
  return number(std::strtod(format_value(registers, point).c_str(), nullptr));
}

ordered_json one_value(const std::uint16_t* registers, const Point& point) {
  if (holds_bits(point.table)) return registers[0] != 0;
  if (point.scale.present()) return scaled(registers, point);
  return std::visit([](const auto& value) { return number(value); }, codec::decode(registers, point.format));
}

}  // namespace

ordered_json value_json(const std::uint16_t* registers, const Point& point) {
  if (point.count == 1) return one_value(registers, point);
  ordered_json list = ordered_json::array();
  for (std::size_t i = 0; i < point.count; ++i)
    list.push_back(one_value(registers + i * codec::registers(point.format), point));
  return list;
}

}  // namespace coupler::host
