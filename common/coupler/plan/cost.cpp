// SPDX-License-Identifier: Apache-2.0
#include "coupler/plan/cost.hpp"

#include <algorithm>

#include "coupler/modbus/limits.hpp"
#include "coupler/modbus/rtu_frame.hpp"
#include "coupler/plan/read_span.hpp"

namespace coupler::plan {
namespace {

constexpr std::size_t request_pdu = 5;  ///< function, address, quantity
constexpr std::size_t reply_head = 2;   ///< function, byte count

std::vector<GroupPlan> plan_with(const Polling& polling, const Map& map) {
  Map other = map;
  other.polling = polling;
  return make_read_plan(other);
}

Strategy strategy(std::string_view name, const Polling& polling, const Map& map,
                  const NetworkTiming& timing) {
  const auto plan = plan_with(polling, map);
  Strategy result{name, polling, {}, load(plan, timing)};
  for (const GroupPlan& group : plan) result.cost += cost_of(group, timing);
  return result;
}

/// The widest hole that is read faster than a request is made, plus one; never wider than a request.
std::uint16_t widest_gap(Table table, const NetworkTiming& timing) {
  const auto request = (timing.round_trip + timing.pause) / timing.byte_time;  // in bytes of values
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

Polling as_pays(const Map& map, const NetworkTiming& timing) {
  Polling polling = map.polling;
  polling.discrete_continuous = polling.register_continuous = true;
  polling.discrete_gap = widest_gap(Table::coils, timing);
  polling.register_gap = widest_gap(Table::holding_registers, timing);
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

NetworkTiming timing_of(const Map& map, std::chrono::nanoseconds answer) {
  NetworkTiming timing{answer, map.limits.request_gap};
  if (map.connection.is_rtu()) timing.framing = modbus::rtu_overhead;
  const Serial& line = map.connection.serial;
  if (!line.present()) return timing;
  timing.round_trip += time_of_characters(line, request_pdu + reply_head + 2 * timing.framing);
  timing.pause = std::max(timing.pause, silence_between_frames(line));
  timing.byte_time = time_of_characters(line, 1);
  return timing;
}

std::uint32_t value_bytes(Table table, std::uint32_t count) {
  return holds_bits(table) ? (count + 7) / 8 : 2 * count;
}

Cost& Cost::operator+=(const Cost& other) {
  requests += other.requests;
  registers += other.registers;
  bits += other.bits;
  bytes += other.bytes;
  time += other.time;
  return *this;
}

Cost cost_of(const ReadSpan& span, const NetworkTiming& timing) {
  const std::uint32_t count = span.range.count();
  const std::uint32_t values = value_bytes(span.table, count);
  Cost cost;
  cost.requests = 1;
  (holds_bits(span.table) ? cost.bits : cost.registers) = count;
  cost.bytes = 2 * timing.framing + request_pdu + reply_head + values;
  cost.time = timing.round_trip + timing.pause + values * timing.byte_time;
  return cost;
}

Cost cost_of(const GroupPlan& group, const NetworkTiming& timing) {
  Cost sum;
  for (const ReadSpan& span : group.spans) sum += cost_of(span, timing);
  return sum;
}

double load(const Cost& cost, double rate) { return std::chrono::duration<double>(cost.time).count() * rate; }

double load(const std::vector<GroupPlan>& plan, const NetworkTiming& timing) {
  double sum = 0;
  for (const GroupPlan& group : plan) sum += load(cost_of(group, timing), group.rate);
  return sum;
}

std::array<Strategy, 3> compare_strategies(const Map& map, const NetworkTiming& timing) {
  Polling never = map.polling;
  never.discrete_continuous = never.register_continuous = false;
  return {strategy("never", never, map, timing), strategy("map", map.polling, map, timing),
          strategy("pays", as_pays(map, timing), map, timing)};
}

}  // namespace coupler::plan
