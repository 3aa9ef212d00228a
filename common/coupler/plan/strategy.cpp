// SPDX-License-Identifier: Apache-2.0
#include "coupler/plan/strategy.hpp"

#include <algorithm>

#include "coupler/plan/split.hpp"

namespace coupler::plan {
namespace {

std::vector<GroupPlan> plan_with(const Polling& polling, const Map& map) {
  Map other = map;
  other.polling = polling;
  return make_read_plan(other);
}

Strategy strategy(std::string_view name, const Polling& polling, const Map& map, const Link& link) {
  const auto plan = plan_with(polling, map);
  Strategy result{name, polling, {}, load(plan, link)};
  for (const GroupPlan& group : plan) result.cost += cost_of(group, link);
  return result;
}

/// The widest hole that is read faster than a request is made, plus one; never wider than a request.
std::uint16_t widest_gap(Table table, const Link& link) {
  const auto request = (link.round_trip + link.pause) / link.byte_time;  // in bytes of values
  const auto addresses = holds_bits(table) ? 8 * request : request / 2;
  const auto limit = holds_bits(table) ? modbus::max_read_bits : modbus::max_read_registers;
  return static_cast<std::uint16_t>(std::clamp<decltype(addresses)>(addresses, 1, limit));
}

/// The widest hole in any request of the bit tables or the register tables.
std::uint32_t widest_hole(const std::vector<GroupPlan>& plan, const Map& map, bool bits) {
  std::uint32_t widest = 0;
  for (const GroupPlan& group : plan)
    for (const ReadSpan& span : group.spans) {
      if (holds_bits(span.table) != bits) continue;
      for (const modbus::Range hole : holes(span, map)) widest = std::max(widest, hole.count());
    }
  return widest;
}

Polling as_pays(const Map& map, const Link& link) {
  Polling polling = map.polling;
  polling.discrete_continuous = polling.register_continuous = true;
  polling.discrete_gap = widest_gap(Table::coils, link);
  polling.register_gap = widest_gap(Table::holding_registers, link);
  const auto plan = plan_with(polling, map);
  const std::uint32_t bits = widest_hole(plan, map, true);
  const std::uint32_t registers = widest_hole(plan, map, false);
  polling.discrete_continuous = bits > 0;
  polling.register_continuous = registers > 0;
  polling.discrete_gap = bits > 0 ? static_cast<std::uint16_t>(bits + 1) : map.polling.discrete_gap;
  polling.register_gap = registers > 0 ? static_cast<std::uint16_t>(registers + 1) : map.polling.register_gap;
  return polling;
}

}  // namespace

std::array<Strategy, 3> compare_strategies(const Map& map, const Link& link) {
  Polling never = map.polling;
  never.discrete_continuous = never.register_continuous = false;
  return {strategy("never", never, map, link), strategy("map", map.polling, map, link),
          strategy("pays", as_pays(map, link), map, link)};
}

}  // namespace coupler::plan
