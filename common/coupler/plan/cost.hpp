// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <chrono>
#include <string_view>
#include <vector>

#include "coupler/modbus/limits.hpp"
#include "coupler/plan/planner.hpp"

namespace coupler::plan {

/// How long the network and the device take for one request.
struct NetworkTiming {
  /// From the smallest request to its reply: the time that ping shows and the device's own.
  std::chrono::nanoseconds round_trip = std::chrono::milliseconds(1);
  /// The pause that the device needs before the next request: Limits::request_gap.
  std::chrono::nanoseconds pause{0};
  /// The time for every byte of values in a reply; by default at 100 Mbit/s.
  std::chrono::nanoseconds byte_time{80};
  std::size_t framing = modbus::mbap_size;  ///< bytes around a PDU
};

/// On the map's way to the device, by Modbus/TCP or RTU: on a serial line the characters take their time
/// (MSL 2.5.1.1). `answer`: what the network and the device take beside that.
NetworkTiming timing_of(const Map& map, std::chrono::nanoseconds answer);

/// The bytes of values in the reply (MAP 6.1 to 6.4).
std::uint32_t value_bytes(Table table, std::uint32_t count);

/// The cost of several requests.
struct Cost {
  std::size_t requests = 0;
  std::size_t registers = 0;
  std::size_t bits = 0;
  std::size_t bytes =
      0;  ///< ADUs of requests and replies (TCP 3.1, MSL 2.5.1); what carries them not counted
  /// round_trip + pause + byte_time × value bytes for each request, one after the other.
  std::chrono::nanoseconds time{0};

  Cost& operator+=(const Cost& other);
};

Cost cost_of(const ReadSpan& span, const NetworkTiming& timing);
/// Returns the cost of one cycle.
Cost cost_of(const GroupPlan& group, const NetworkTiming& timing);

/// The part of the time that requests which cost so much take at `rate` Hz; above 1 they do not fit.
double load(const Cost& cost, double rate);
/// Returns the load of all rates together.
double load(const std::vector<GroupPlan>& plan, const NetworkTiming& timing);

/// A way to treat unmapped addresses between points, and what it would cost.
struct Strategy {
  std::string_view name;
  Polling polling;  ///< the map's with the keys that the way needs
  Cost cost;        ///< of one cycle of every rate
  double load = 0;  ///< of all rates together
};

/// Never read them; as the map says; wherever that is quicker than another request. The last one's gaps are
/// the smallest that do it. It presumes that the device answers them.
std::array<Strategy, 3> compare_strategies(const Map& map, const NetworkTiming& timing);

}  // namespace coupler::plan
