// SPDX-License-Identifier: Apache-2.0
#include "coupler/cli/plan_report.hpp"

#include <nlohmann/json.hpp>

#include "coupler/plan/cost.hpp"
#include "coupler/plan/explain.hpp"
#include "coupler/plan/read_span.hpp"

namespace coupler::cli {
namespace {

using nlohmann::ordered_json;

double milliseconds(std::chrono::nanoseconds time) {
  return std::chrono::duration<double, std::milli>(time).count();
}

ordered_json cost_json(const plan::Cost& cost) {
  return {{"requests", cost.requests},
          {"registers", cost.registers},
          {"bits", cost.bits},
          {"bytes", cost.bytes},
          {"time_ms", milliseconds(cost.time)}};
}

ordered_json end_json(const plan::ReadSpan& span, const Map& map) {
  const auto key = plan::key_of(span.end.reason, span.table);
  ordered_json end{{"reason", plan::to_string(span.end.reason)},
                   {"text", plan::explain_end(span, map)},
                   {"next", nullptr},
                   {"between", span.end.between},
                   {"key", nullptr}};
  if (span.end.next) end["next"] = map.points[*span.end.next].name;
  if (!key.empty()) end["key"] = key;
  return end;
}

ordered_json span_json(const plan::ReadSpan& span, const Map& map) {
  ordered_json json{
      {"table", to_string(span.table)},  {"from", span.range.start()},
      {"to", span.range.last()},         {"modicon", plan::modicon(span.table, span.range.start())},
      {"points", ordered_json::array()}, {"holes", ordered_json::array()},
      {"end", end_json(span, map)}};
  for (const std::uint32_t point : span.points) json["points"].push_back(map.points[point].name);
  for (const modbus::Range hole : plan::holes(span, map))
    json["holes"].push_back({{"from", hole.start()}, {"to", hole.last()}});
  return json;
}

ordered_json group_json(const plan::GroupPlan& group, const Map& map, const plan::NetworkTiming& timing) {
  const plan::Cost cost = cost_of(group, timing);
  ordered_json json{{"rate_hz", group.rate}, {"period_ms", 1000 / group.rate}};
  json.update(cost_json(cost));
  json["load"] = plan::load(cost, group.rate);
  json["spans"] = ordered_json::array();
  for (const plan::ReadSpan& span : group.spans) json["spans"].push_back(span_json(span, map));
  return json;
}

ordered_json strategy_json(const plan::Strategy& strategy) {
  const Polling& polling = strategy.polling;
  ordered_json json{{"name", strategy.name}};
  json.update(cost_json(strategy.cost));
  json["load"] = strategy.load;
  json["keys"] = {{"discrete_read_continuous", polling.discrete_continuous},
                  {"discrete_read_separation_gap", polling.discrete_gap},
                  {"registers_read_continuous", polling.register_continuous},
                  {"registers_read_separation_gap", polling.register_gap}};
  return json;
}

}  // namespace

std::string plan_json(const std::string& file, const Map& map, const plan::NetworkTiming& timing) {
  const auto groups = plan::make_read_plan(map);
  const double load = plan::load(groups, timing);
  ordered_json json{{"file", file},
                    {"name", map.name},
                    {"rtt_ms", milliseconds(timing.round_trip)},
                    {"request_gap_ms", milliseconds(timing.pause)},
                    {"load", load},
                    {"fits", load <= 1},
                    {"groups", ordered_json::array()},
                    {"not_read", ordered_json::array()},
                    {"strategies", ordered_json::array()}};
  for (const plan::GroupPlan& group : groups) json["groups"].push_back(group_json(group, map, timing));
  for (const Point& point : map.points)
    if (const auto reason = plan::why_not_read(map, point))
      json["not_read"].push_back({{"point", point.name}, {"reason", plan::to_string(*reason)}});
  for (const plan::Strategy& strategy : plan::compare_strategies(map, timing))
    json["strategies"].push_back(strategy_json(strategy));
  // A file's name may have bytes that are not UTF-8.
  return json.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

}  // namespace coupler::cli
