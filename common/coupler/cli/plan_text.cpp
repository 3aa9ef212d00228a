// SPDX-License-Identifier: Apache-2.0
#include "coupler/cli/plan_report.hpp"

#include <algorithm>
#include <map>
#include <vector>

#include <fmt/format.h>

#include "coupler/plan/cost.hpp"
#include "coupler/plan/explain.hpp"

namespace coupler::cli {
namespace {

using plan::Strategy;

std::string counted(std::size_t count, std::string_view noun) {
  return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

std::string milliseconds(std::chrono::nanoseconds time) {
  return fmt::format("{:.4g} ms", std::chrono::duration<double, std::milli>(time).count());
}

/// What is read: "12 registers and 3 bits".
std::string amount(const plan::Cost& cost) {
  if (cost.bits == 0) return counted(cost.registers, "register");
  if (cost.registers == 0) return counted(cost.bits, "bit");
  return counted(cost.registers, "register") + " and " + counted(cost.bits, "bit");
}

std::string group_text(const plan::GroupPlan& group, const Map& map, const plan::NetworkTiming& timing) {
  const plan::Cost cost = cost_of(group, timing);
  const auto period = std::chrono::duration<double, std::milli>(1000 / group.rate).count();
  auto text = fmt::format("{:g} Hz: {}, {}, {} bytes; {} of {:.4g} ms ({})\n", group.rate,
                          counted(cost.requests, "request"), amount(cost), cost.bytes,
                          milliseconds(cost.time), period, percent(plan::load(cost, group.rate)));
  if (group.spans.empty()) return text;
  const auto row = [&text](auto&&... cells) {
    text += fmt::format("  {:<17}  {:>14}  {:>15}  {:>6}  {}\n", cells...);
  };
  row("table", "wire", "Modicon", "points", "ends because");
  for (const plan::ReadSpan& span : group.spans)
    row(to_string(span.table), fmt::format("{} to {}", span.range.start(), span.range.last()),
        plan::modicon(span.table, span.range.start()) + "-" + plan::modicon(span.table, span.range.last()),
        span.points.size(), plan::explain_end(span, map));
  return text;
}

std::string_view text_of(plan::NotRead reason) {
  switch (reason) {
    case plan::NotRead::write_only: return "can only be written";
    case plan::NotRead::unreadable: return "lie in what the map calls unreadable";
    case plan::NotRead::too_long: return "fit into no reply";
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
  if (std::all_of(strategies.begin(), strategies.end(), [&](const Strategy& strategy) {
        return strategy.cost.requests == strategies.front().cost.requests;
      }))
    return {};
  const bool pays = strategies[2].cost.requests < strategies[1].cost.requests;
  std::string text = "\nUnmapped addresses between points:\n";
  constexpr std::string_view names[] = {"never read", "as the map says", "read where quicker"};
  for (std::size_t i = 0; i < strategies.size(); ++i)
    text += fmt::format("  {:<18}  {:>12}  {:>9}  {:>6}{}\n", names[i],
                        counted(strategies[i].cost.requests, "request"),
                        milliseconds(strategies[i].cost.time), percent(strategies[i].load),
                        i == 2 && pays ? keys_text(strategies[i].polling, map.polling) : "");
  if (pays)
    text += "  The last is for a device that answers unmapped addresses. coupler-node refuses them.\n";
  return text;
}

}  // namespace

std::string percent(double load) {
  return load > 0 && load < 0.001 ? "< 0.1 %" : fmt::format("{:.3g} %", 100 * load);
}

std::string plan_text(const std::string& file, const Map& map, const plan::NetworkTiming& timing) {
  const auto groups = plan::make_read_plan(map);
  std::size_t requests = 0;
  for (const plan::GroupPlan& group : groups) requests += group.spans.size();
  auto text =
      fmt::format("{}: {}, {} in {}, round trip {}{}\n", file, map.name, counted(map.points.size(), "point"),
                  counted(requests, "request"), milliseconds(timing.round_trip),
                  timing.pause.count() > 0 ? " and a pause of " + milliseconds(timing.pause) : "");
  for (const plan::GroupPlan& group : groups) text += "\n" + group_text(group, map, timing);
  return text + not_read_text(map) + strategies_text(map, timing);
}

}  // namespace coupler::cli
