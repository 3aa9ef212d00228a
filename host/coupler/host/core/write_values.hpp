// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "coupler/host/core/transport.hpp"
#include "coupler/host/core/write_batch.hpp"

namespace coupler::host {

/// Makes the request of a batch, and the reading before it where a part of a register needs that, and waits.
Result<> exchange(const WriteBatch& batch, const Map& map, Transport& transport);

/// A value that the device did not take.
struct RefusedValue {
  std::uint32_t point;
  modbus::Exception code;
};

/// Writes values that no caller waits for, neighbours in one request. Returns those that were refused; an
/// error means that the link broke on the way.
Result<std::vector<RefusedValue>> write_values(const std::vector<Write>& writes, const Map& map,
                                               Transport& transport);

/// The value that each output has for the time when nobody is in command: Point::safe and Point::safe_value;
/// none for those that hold theirs. A register without a safe value of its own is left alone unless it is an
/// analogue output.
std::vector<Write> safe_values(const Map& map);

}  // namespace coupler::host
