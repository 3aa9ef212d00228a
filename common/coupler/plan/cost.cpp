// SPDX-License-Identifier: Apache-2.0
#include "coupler/plan/cost.hpp"

#include "coupler/modbus/limits.hpp"

namespace coupler::plan {
namespace {

constexpr std::size_t request_pdu = 5;  ///< function, address, quantity
constexpr std::size_t reply_head = 2;   ///< function, byte count

}  // namespace

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

Cost cost_of(const ReadSpan& span, const Link& link) {
  const std::uint32_t count = span.range.count();
  const std::uint32_t values = value_bytes(span.table, count);
  Cost cost;
  cost.requests = 1;
  (holds_bits(span.table) ? cost.bits : cost.registers) = count;
  cost.bytes = 2 * modbus::mbap_size + request_pdu + reply_head + values;
  cost.time = link.round_trip + link.pause + values * link.byte_time;
  return cost;
}

Cost cost_of(const GroupPlan& group, const Link& link) {
  Cost sum;
  for (const ReadSpan& span : group.spans) sum += cost_of(span, link);
  return sum;
}

double load(const Cost& cost, double rate) { return std::chrono::duration<double>(cost.time).count() * rate; }

double load(const std::vector<GroupPlan>& plan, const Link& link) {
  double sum = 0;
  for (const GroupPlan& group : plan) sum += load(cost_of(group, link), group.rate);
  return sum;
}

}  // namespace coupler::plan
