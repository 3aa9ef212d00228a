// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/cli/field_map.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "coupler/host/modbus/multi_unit_transport.hpp"
#include "coupler/map/field_side.hpp"
#include "coupler/map/fingerprint.hpp"
#include "coupler/map/node_address.hpp"

namespace coupler::cli {
namespace {

bool is_free_input(const Point& point, const Map& node) {
  return !is_writable(point.table) && !point.counter.present() &&
         std::none_of(node.sim.begin(), node.sim.end(),
                      [&](const SimWire& wire) { return wire.to == point.name; });
}

}  // namespace

FieldMap::FieldMap(const Map& node) : points_(node.points.begin(), node.points.end()), map_(node) {
  for (Point& point : points_) {
    point.access = is_free_input(point, node) ? Access::read_write : Access::read;
    point.table = seen_from_field(point.table);
    point.bounds = {};
    point.host = {};
  }
  std::sort(points_.begin(), points_.end(), canonical_less);
  map_.points = {points_.data(), points_.size()};
  map_.sim = {};
  map_.connection.unit = field_unit;
  map_.limits.mask_write = false;
  map_.changes = false;
  map_.verify = Verify::off;
}

std::string FieldMap::why_missing() const {
  if (map_.points.empty()) return {};
  const auto transport = host::make_transport(map_.connection);
  const Point& point = map_.points[0];
  std::array<std::uint16_t, modbus::max_read_registers> registers{};
  auto answer = transport->connect();
  if (answer) answer = transport->read(point.table, modbus::Range::of(point.address, 1), registers.data());
  if (answer) return {};
  return fmt::format("unit {} of {} does not answer: {}", field_unit, node_address_text(map_.connection),
                     host::to_string(answer.error()));
}

}  // namespace coupler::cli
