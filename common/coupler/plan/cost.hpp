// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <vector>

#include "coupler/plan/planner.hpp"

namespace coupler::plan {

/// What the network and the device take for one request.
struct Link {
  /// From the smallest request to its reply; what ping shows and the device's own time.
  std::chrono::nanoseconds round_trip = std::chrono::milliseconds(1);
  /// The pause that the device needs before the next request: Limits::request_gap.
  std::chrono::nanoseconds pause{0};
  /// For every byte of values in a reply: at 100 Mbit/s.
  std::chrono::nanoseconds byte_time{80};
};

/// The bytes of values in the reply (MAP 6.1 to 6.4).
std::uint32_t value_bytes(Table table, std::uint32_t count);

/// What requests cost in sum.
struct Cost {
  std::size_t requests = 0;
  std::size_t registers = 0;
  std::size_t bits = 0;
  std::size_t bytes = 0;  ///< ADUs of requests and replies (TCP 3.1); what carries them not counted
  /// round_trip + pause + byte_time × value bytes for each request, one after the other.
  std::chrono::nanoseconds time{0};

  Cost& operator+=(const Cost& other);
};

Cost cost_of(const ReadSpan& span, const Link& link);
/// Of one cycle.
Cost cost_of(const GroupPlan& group, const Link& link);

/// The part of its time that the link is busy with `cost` at `rate` Hz; above 1 it does not fit.
double load(const Cost& cost, double rate);
/// Of all rates together.
double load(const std::vector<GroupPlan>& plan, const Link& link);

}  // namespace coupler::plan
