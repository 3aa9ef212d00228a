// SPDX-License-Identifier: Apache-2.0
#include "coupler/tools/dump_output.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "coupler/base/utc_text.hpp"
#include "coupler/host/core/health.hpp"
#include "coupler/host/core/value_text.hpp"
#include "coupler/host/record/value_json.hpp"
#include "coupler/json/json_text.hpp"
#include "coupler/map/node_address.hpp"

namespace coupler::tools {
namespace {

using nlohmann::ordered_json;

ordered_json reading_json(const Map& map, const Reading& reading) {
  const Point& point = map.points[reading.point];
  const bool good = reading.state == Reading::State::good;
  ordered_json json{{"point", point.name},
                    {"value", nullptr},
                    {"text", nullptr},
                    {"units", point.units},
                    {"changed", reading.changed},
                    {"failed", reading.state == Reading::State::failed},
                    {"invalid", reading.state == Reading::State::invalid},
                    {"fault", reading.state == Reading::State::fault},
                    {"why", nullptr},
                    {"exception", nullptr},
                    {"type", codec::to_string(point.format.type)},
                    {"count", point.count},
                    {"table", to_string(point.table)},
                    {"address", read_range(point).start()}};
  if (good) {
    json["value"] = host::value_json(reading.registers.data(), point);
    json["text"] = host::format_value(reading.registers.data(), point);
  } else {
    json["why"] = reading.why;
  }
  if (reading.exception) json["exception"] = static_cast<unsigned>(*reading.exception);
  return json;
}

}  // namespace

std::string dump_json(const Map& map, const Snapshot& now) {
  ordered_json json{{"name", map.name},         {"device", node_address_text(map.connection)},
                    {"time", utc_text(now.at)}, {"online", now.online()},
                    {"trouble", nullptr},       {"identity", host::to_string(now.identity)},
                    {"notes", now.notes},       {"points", ordered_json::array()}};
  if (now.error) json["trouble"] = host::to_string(*now.error);
  for (const Reading& reading : now.readings) json["points"].push_back(reading_json(map, reading));
  return json_text(json);
}

}  // namespace coupler::tools
