// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/cli/dump_output.hpp"

#include <cmath>
#include <cstdlib>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "coupler/codec/value.hpp"
#include "coupler/host/core/health.hpp"
#include "coupler/host/core/value_text.hpp"
#include "coupler/map/node_address.hpp"

namespace coupler::cli {
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
  return number(std::strtod(host::format_value(registers, point).c_str(), nullptr));
}

ordered_json one_value(const std::uint16_t* registers, const Point& point) {
  if (holds_bits(point.table)) return registers[0] != 0;
  if (point.scale.present()) return scaled(registers, point);
  return std::visit([](const auto& value) { return number(value); }, codec::decode(registers, point.format));
}

ordered_json value_json(const Point& point, const Reading& reading) {
  if (point.count == 1) return one_value(reading.registers.data(), point);
  ordered_json list = ordered_json::array();
  for (std::size_t i = 0; i < point.count; ++i)
    list.push_back(one_value(reading.registers.data() + i * codec::registers(point.format), point));
  return list;
}

ordered_json reading_json(const Map& map, const Reading& reading) {
  const Point& point = map.points[reading.point];
  const bool good = reading.state == Reading::State::good;
  ordered_json json{{"point", point.name},
                    {"value", nullptr},
                    {"text", nullptr},
                    {"units", point.units},
                    {"changed", reading.changed},
                    {"failed", reading.state == Reading::State::failed},
                    {"why", nullptr},
                    {"exception", nullptr},
                    {"type", codec::to_string(point.format.type)},
                    {"count", point.count},
                    {"table", to_string(point.table)},
                    {"address", read_range(point).start()}};
  if (good) {
    json["value"] = value_json(point, reading);
    json["text"] = host::format_value(reading.registers.data(), point);
  } else {
    json["why"] = reading.why;
  }
  if (reading.exception) json["exception"] = static_cast<unsigned>(*reading.exception);
  return json;
}

}  // namespace

std::string dump_json(const Map& map, const Snapshot& now) {
  ordered_json json{{"name", map.name},          {"device", node_address_text(map.connection)},
                    {"time", time_text(now.at)}, {"online", now.online()},
                    {"trouble", nullptr},        {"identity", host::to_string(now.identity)},
                    {"notes", now.notes},        {"points", ordered_json::array()}};
  if (!now.online()) json["trouble"] = now.error_text;
  for (const Reading& reading : now.readings) json["points"].push_back(reading_json(map, reading));
  // A text of the device need not be UTF-8.
  return json.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

}  // namespace coupler::cli
