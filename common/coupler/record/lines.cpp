// SPDX-License-Identifier: Apache-2.0
#include "coupler/record/lines.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "coupler/base/utc_text.hpp"
#include "coupler/json/json_text.hpp"

namespace coupler::record {
namespace {

using nlohmann::ordered_json;

double seconds(Nanoseconds time) { return std::chrono::duration<double>(time).count(); }

/// `rest`: members of the object.
std::string line(Moment at, std::string_view rest) {
  return fmt::format("{{\"t\":{:.6f},\"utc\":\"{}\",{}}}\n", seconds(at.since_start), utc_text(at.wall),
                     rest);
}

ordered_json object_of(const std::vector<std::pair<std::string, std::string>>& members) {
  ordered_json object = ordered_json::object();
  for (const auto& [key, value] : members) object[key] = value;
  return object;
}

}  // namespace

std::string head_line(const Head& head, Moment at) {
  ordered_json periods = ordered_json::object();
  for (const auto& [point, period] : head.periods) periods[point] = period;
  const ordered_json json{{"record", format_version},
                          {"name", head.name},
                          {"device", head.device},
                          {"fingerprint", head.fingerprint},
                          {"began", utc_text(at.wall - at.since_start)},
                          {"t", seconds(at.since_start)},
                          {"utc", utc_text(at.wall)},
                          {"periods", std::move(periods)},
                          {"not_recorded", object_of(head.not_recorded)},
                          {"may_miss", object_of(head.may_miss)},
                          {"map", head.map}};
  return json_text(json) + '\n';
}

std::string value_line(Moment at, std::string_view point, std::string_view value, Nanoseconds uncertainty,
                       Span<const std::uint16_t> registers, std::string_view quality) {
  std::string rest = fmt::format("\"point\":\"{}\",\"value\":{},\"quality\":\"{}\",\"u\":{:.6f}", point,
                                 value, quality, seconds(uncertainty));
  if (!registers.empty()) rest += fmt::format(",\"registers\":[{}]", fmt::join(registers, ","));
  return line(at, rest);
}

std::string no_value_line(Moment at, std::string_view point, std::string_view quality, unsigned exception) {
  return line(at, fmt::format(R"("point":"{}","value":null,"quality":"{}"{})", point, quality,
                              exception == 0 ? "" : fmt::format(R"(,"exception":{})", exception)));
}

std::string online_line(Moment at, std::optional<bool> is_node) {
  return line(
      at, fmt::format(R"("device":"online"{})", is_node ? fmt::format(R"(,"foreign":{})", !*is_node) : ""));
}

std::string lost_line(Moment at, std::string_view why) {
  return line(at, fmt::format(R"("device":"lost","why":{})", json_text(ordered_json(std::string(why)))));
}

std::string clock_line(Moment at, Nanoseconds set_by) {
  return line(at, fmt::format("\"clock\":{:.6f}", seconds(set_by)));
}

std::string missing_line(Moment at, Nanoseconds since, std::string_view why) {
  return line(at, fmt::format("\"missing_since\":{:.6f},\"why\":{}", seconds(since),
                              json_text(ordered_json(std::string(why)))));
}

std::string end_line(Moment at) { return line(at, R"("end":true)"); }

}  // namespace coupler::record
