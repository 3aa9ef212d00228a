// SPDX-License-Identifier: Apache-2.0
#include "coupler/tools/field_map.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "coupler/host/core/node_map.hpp"
#include "coupler/host/modbus/make_links.hpp"
#include "coupler/map/field_side.hpp"
#include "coupler/map/fingerprint.hpp"
#include "coupler/map/node_address.hpp"

namespace coupler::tools {
namespace {

bool is_free_input(const Point& point, const Map& node) {
  return !is_writable(point.table) && !point.counter.present() &&
         std::none_of(node.sim.begin(), node.sim.end(),
                      [&](const SimWire& wire) { return wire.to == point.name; });
}

}  // namespace

FieldMap::FieldMap(const Map& node)
    : node_(node.connection), points_(node.points.begin(), node.points.end()), map_(node) {
  for (Point& point : points_) {
    point.access = is_free_input(point, node) ? Access::read_write : Access::read;
    point.table = seen_from_field(point.table);
    point.bounds = {};
    point.invalid = {};
    point.faults = {};
    point.scale.exponent_of = {};
    point.host = {};
  }
  std::sort(points_.begin(), points_.end(), canonical_less);
  map_.points = {points_.data(), points_.size()};
  map_.sim = {};
  map_.tools = {};
  map_.axes = {};
  map_.connection.unit = field_unit;
  map_.limits.mask_write = false;
  map_.changes = false;
  map_.verify = Verify::off;
}

std::string FieldMap::why_missing() const {
  host::Link link = host::make_link(node_);
  const auto connected = link.connect();
  if (!connected) return host::to_string(connected.error()) + "; check that a node serves there";
  const auto head = host::read_identity(link);
  if (!head) return "the device does not say what it is: " + host::to_string(head.error());
  const auto further = *head ? host::read_further(link) : identity::Further{};
  if (!further) return "the node does not say what it can do: " + host::to_string(further.error());
  if (further->functions.has_field_side) return {};
  return fmt::format(
      "{} has no field side; only a coupler-node that runs with --sim has one, and whose own unit is not {}",
      node_address_text(node_), field_unit);
}

}  // namespace coupler::tools
