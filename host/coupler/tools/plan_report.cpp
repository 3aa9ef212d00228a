// SPDX-License-Identifier: Apache-2.0
#include "coupler/tools/plan_report.hpp"

#include <algorithm>
#include <chrono>
#include <map>
#include <string_view>
#include <type_traits>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "coupler/docs/axis_description.hpp"
#include "coupler/docs/tool_description.hpp"
#include "coupler/json/json_text.hpp"
#include "coupler/map/fields.hpp"
#include "coupler/map/joint.hpp"
#include "coupler/plan/cost.hpp"
#include "coupler/plan/explain.hpp"
#include "coupler/plan/read_span.hpp"

namespace coupler::tools {
namespace {

using nlohmann::ordered_json;

double milliseconds(std::chrono::nanoseconds time) {
  return std::chrono::duration<double, std::milli>(time).count();
}

std::string counted(std::size_t count, std::string_view noun) {
  return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

/// Returns a number with `at_most` significant digits, or a large one as a whole number, never as 1e+04.
std::string digits(double value, int at_most) {
  return value < 999 ? fmt::format("{:.{}g}", value, at_most) : fmt::format("{:.0f}", value);
}

std::string milliseconds_text(std::chrono::duration<double, std::milli> time) {
  return digits(time.count(), 4) + " ms";
}

/// Returns a text for what is read: "12 registers and 3 bits".
std::string amount(const plan::Cost& cost) {
  if (cost.bits == 0) return counted(cost.registers, "register");
  if (cost.registers == 0) return counted(cost.bits, "bit");
  return counted(cost.registers, "register") + " and " + counted(cost.bits, "bit");
}

std::string group_text(const plan::GroupPlan& group, const Map& map, const plan::NetworkTiming& timing) {
  const plan::Cost cost = cost_of(group, timing);
  const std::chrono::duration<double, std::milli> period(1000 / group.rate);
  auto text =
      fmt::format("{:g} Hz: {}, {}, {} bytes; {} of {} ({})\n", group.rate, counted(cost.requests, "request"),
                  amount(cost), cost.bytes, milliseconds_text(cost.time), milliseconds_text(period),
                  percent(plan::load(cost, group.rate)));
  if (group.spans.empty()) return text;
  const auto row = [&text](auto&&... cells) {
    text += fmt::format("  {:<17}  {:>14}  {:>15}  {:>6}  {}\n", cells...);
  };
  row("table", "address", "Modicon", "points", "ends because");
  for (const plan::ReadSpan& span : group.spans)
    row(to_string(span.table), fmt::format("{} to {}", span.range.start(), span.range.last()),
        plan::modicon(span.table, span.range.start()) + "-" + plan::modicon(span.table, span.range.last()),
        span.points.size(), plan::explain_end(span, map));
  return text;
}

std::string_view text_of(plan::NotRead reason) {
  switch (reason) {
    case plan::NotRead::write_only: return "write-only";
    case plan::NotRead::unreadable: return "in an area that the map calls unreadable";
    case plan::NotRead::too_long: return "longer than a reply";
  }
  return "";
}

std::string not_read_text(const Map& map) {
  std::map<plan::NotRead, std::string> names;
  for (const Point& point : map.points)
    if (const auto reason = plan::why_not_read(map, point))
      names[*reason] += fmt::format("{}{}", names[*reason].empty() ? "" : ", ", point.name);
  std::string text;
  for (const auto& [reason, list] : names) text += fmt::format("Not read, {}: {}\n", text_of(reason), list);
  return text.empty() ? text : "\n" + text;
}

/// A table of the tools or the axes; empty if the map has none.
template <class Description>
std::string table_text(std::string_view title, const std::vector<Description>& rows) {
  if (rows.empty()) return {};
  std::vector<std::string> lines(1 + rows.size());
  for (const auto& column : docs::used_columns(rows)) {
    std::size_t width = column.title.size();
    for (const Description& row : rows) width = std::max(width, (row.*column.text).size());
    lines[0] += fmt::format("  {:<{}}", column.title, width);
    for (std::size_t i = 0; i < rows.size(); ++i)
      lines[1 + i] += fmt::format("  {:<{}}", rows[i].*column.text, width);
  }
  std::string text = fmt::format("\n{}:\n", title);
  for (const std::string& line : lines) text += line.substr(0, line.find_last_not_of(' ') + 1) + '\n';
  return text;
}

/// The keys that differ from the map's.
std::string keys_text(const Polling& polling, const Polling& map) {
  std::vector<std::string> keys;
  if (polling.discrete_continuous != map.discrete_continuous)
    keys.push_back(fmt::format("discrete_read_continuous: {}", polling.discrete_continuous));
  if (polling.discrete_gap != map.discrete_gap)
    keys.push_back(fmt::format("discrete_read_separation_gap: {}", polling.discrete_gap));
  if (polling.register_continuous != map.register_continuous)
    keys.push_back(fmt::format("registers_read_continuous: {}", polling.register_continuous));
  if (polling.register_gap != map.register_gap)
    keys.push_back(fmt::format("registers_read_separation_gap: {}", polling.register_gap));
  return keys.empty() ? "" : fmt::format("  {}", fmt::join(keys, ", "));
}

std::string strategies_text(const Map& map, const plan::NetworkTiming& timing) {
  const auto strategies = plan::compare_strategies(map, timing);
  if (std::all_of(strategies.begin(), strategies.end(), [&](const plan::Strategy& strategy) {
        return strategy.cost.requests == strategies.front().cost.requests;
      }))
    return {};
  const bool pays = strategies[2].cost.requests < strategies[1].cost.requests;
  std::string text = "\nUnmapped addresses between points:\n";
  constexpr std::string_view names[] = {"never read", "as the map says", "read where quicker"};
  for (std::size_t i = 0; i < strategies.size(); ++i)
    text += fmt::format("  {:<18}  {:>12}  {:>9}  {:>6}{}\n", names[i],
                        counted(strategies[i].cost.requests, "request"),
                        milliseconds_text(strategies[i].cost.time), percent(strategies[i].load),
                        i == 2 && pays ? keys_text(strategies[i].polling, map.polling) : "");
  if (pays)
    text += "  The last is for a device that answers unmapped addresses. coupler-node refuses them.\n";
  return text;
}

/// Returns the values of fields_of(Struct) by their keys.
template <class Struct>
ordered_json fields_json(const Struct& object) {
  ordered_json json;
  for_each_field(object, [&](const auto& field, const auto& value) {
    using Value = std::decay_t<decltype(value)>;
    const std::string key(field.key);
    if constexpr (std::is_same_v<Value, std::chrono::milliseconds>)
      json[key + "_ms"] = value.count();
    else if constexpr (std::is_same_v<Value, std::string_view>)
      json[key] = value.empty() ? ordered_json() : ordered_json(value);
    else if constexpr (std::is_enum_v<Value>)
      json[key] = to_string(value);
    else if constexpr (has_fields<Value>)
      json[key] = fields_json(value);
    else
      json[key] = value;
  });
  return json;
}

ordered_json tool_json(const Map& map, const Tool& tool) {
  ordered_json json{{"name", tool.name}};
  json.update(fields_json(tool));
  json["joint"] = joint_name(map, tool);
  return json;
}

ordered_json axis_json(const Map& map, const Axis& axis) {
  ordered_json json{{"name", axis.name},
                    {"point", axis.point},
                    {"joint", joint_name(map, axis)},
                    {"positions", ordered_json::array()}};
  for (const auto& [value, position] : axis.positions)
    json["positions"].push_back({{"value", value}, {"position", position}});
  return json;
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

std::string percent(double load) {
  return load > 0 && load < 0.001 ? "< 0.1 %" : digits(100 * load, 3) + " %";
}

std::string plan_text(const std::string& file, const Map& map, const plan::NetworkTiming& timing) {
  const auto groups = plan::make_read_plan(map);
  std::size_t requests = 0;
  for (const plan::GroupPlan& group : groups) requests += group.spans.size();
  auto text =
      fmt::format("{}: {}, {} in {}, round trip {}{}\n", file, map.name, counted(map.points.size(), "point"),
                  counted(requests, "request"), milliseconds_text(timing.round_trip),
                  timing.pause.count() > 0 ? " and a pause of " + milliseconds_text(timing.pause) : "");
  for (const plan::GroupPlan& group : groups) text += "\n" + group_text(group, map, timing);
  return text + not_read_text(map) + table_text("Tools", docs::describe_tools(map)) +
         table_text("Axes", docs::describe_axes(map)) + strategies_text(map, timing);
}

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
                    {"tools", ordered_json::array()},
                    {"axes", ordered_json::array()},
                    {"strategies", ordered_json::array()}};
  for (const plan::GroupPlan& group : groups) json["groups"].push_back(group_json(group, map, timing));
  for (const Point& point : map.points)
    if (const auto reason = plan::why_not_read(map, point))
      json["not_read"].push_back({{"point", point.name}, {"reason", plan::to_string(*reason)}});
  for (const Tool& tool : map.tools) json["tools"].push_back(tool_json(map, tool));
  for (const Axis& axis : map.axes) json["axes"].push_back(axis_json(map, axis));
  for (const plan::Strategy& strategy : plan::compare_strategies(map, timing))
    json["strategies"].push_back(strategy_json(strategy));
  return json_text(json);
}

}  // namespace coupler::tools
