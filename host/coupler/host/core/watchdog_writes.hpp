// SPDX-License-Identifier: Apache-2.0
// The requests that a coupler's own watchdog needs. A unit that is away is an error here, any other exception
// an answer.
#pragma once

#include <optional>
#include <string>

#include "coupler/host/core/transport.hpp"
#include "coupler/map/watchdog.hpp"

namespace coupler::host {

/// A write that the coupler did not take.
struct RefusedStep {
  WatchdogSequences::Write step;
  modbus::Exception code;
};

/// "exception 02 (illegal data address) for 5 at holding_registers 4096", and what to do about it.
std::string to_string(const RefusedStep& refused);

/// Makes one write (FC 5 or 6).
Result<std::optional<RefusedStep>> write_step(const WatchdogSequences::Write& step, Transport& transport);

/// Makes the writes one after the other, up to the first that is refused.
Result<std::optional<RefusedStep>> write_steps(Span<const WatchdogSequences::Write> steps,
                                               Transport& transport);

/// Whether the place reads as the value. Not if it cannot be read.
Result<bool> has_value(const WatchdogSequences::Write& place, Transport& transport);

}  // namespace coupler::host
