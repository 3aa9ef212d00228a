// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>

#include "coupler/modbus/pdu.hpp"

namespace coupler::modbus {

/// A point in time on the node's clock, which counts from the machine's start (CLOCK_MONOTONIC). 8 bytes in a
/// PDU.
using NodeTime = std::chrono::nanoseconds;

constexpr NodeTime get_time(const std::uint8_t* at) {
  return NodeTime(static_cast<std::int64_t>(get_u64(at)));
}
constexpr void put_time(std::uint8_t* at, NodeTime time) {
  put_u64(at, static_cast<std::uint64_t>(time.count()));
}

}  // namespace coupler::modbus
