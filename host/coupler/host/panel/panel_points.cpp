// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/panel/panel_points.hpp"

#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "coupler/codec/bit_string.hpp"
#include "coupler/docs/point_description.hpp"
#include "coupler/host/panel/word_bits.hpp"
#include "coupler/json/json_text.hpp"
#include "coupler/map/node_address.hpp"

namespace coupler::host {
namespace {

using nlohmann::ordered_json;

bool is_number(const Point& point) {
  return point.count == 1 && point.format.type != codec::Type::BOOL &&
         point.format.type != codec::Type::STRING && !codec::is_bit_string(point.format.type);
}

/// Returns the input that a page shows for a point that can be written.
ordered_json write_json(const Point& point, const std::string& range) {
  if (is_single_bit(point)) return {{"kind", "switch"}};
  if (is_number(point)) return {{"kind", "number"}, {"range", range}};
  const std::string_view example = point.count > 1                           ? "as [1, 2, 3]"
                                   : codec::is_bit_string(point.format.type) ? "as 0x00FF"
                                                                             : "";
  return {{"kind", "text"}, {"range", example}};
}

ordered_json point_json(const Point& point, bool writes) {
  const docs::PointDescription said = docs::describe(point, 0);
  ordered_json json{{"name", said.name},
                    {"description", said.description},
                    {"units", said.units},
                    {"type", said.count.empty() ? said.type : fmt::format("{}[{}]", said.type, said.count)},
                    {"place", fmt::format("{} {}{}{}", to_string(said.table), said.address,
                                          said.part.empty() ? "" : ", ", said.part)},
                    {"modicon", said.modicon}};
  if (const unsigned bits = bits_of(point); bits > 0) json["bits"] = bits;
  for (const NamedValue& value : point.values) json["values"].push_back({value.value, value.name});
  if (!is_readable(point)) json["write_only"] = true;
  if (writes && is_writable(point)) json["write"] = write_json(point, said.range);
  return json;
}

}  // namespace

std::string panel_points(const Map& map, bool writes, std::string_view warning) {
  ordered_json points = ordered_json::array();
  for (const Point& point : map.points)
    if (is_readable(point) || (writes && is_writable(point))) points.push_back(point_json(point, writes));
  ordered_json json{{"name", map.name}, {"place", node_address_text(map.connection)}, {"writes", writes}};
  if (!warning.empty()) json["warning"] = warning;
  json["points"] = std::move(points);
  return json_text(json);
}

}  // namespace coupler::host
