// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "coupler/host/core/error.hpp"
#include "coupler/host/core/histogram.hpp"

namespace coupler::host {

/// The numbers of requests to a unit, since the program began, and how they ended.
struct RequestCounts {
  std::uint64_t requests = 0;
  std::uint64_t timeouts = 0;
  std::uint64_t failures = 0;                   ///< requests without a valid reply for another reason
  std::array<std::uint64_t, 256> exceptions{};  ///< by code
  Histogram latency;                            ///< from request to reply

  /// Counts a request. `error` is null if it got a valid reply that is no exception.
  void add(Duration after, const Error* error) {
    ++requests;
    const ExceptionReply* exception = error != nullptr ? exception_in(*error) : nullptr;
    if (exception != nullptr && !exception->other_value)
      ++exceptions[static_cast<std::size_t>(exception->code)];
    if (error == nullptr || exception != nullptr)
      latency.add(after);
    else
      ++(std::holds_alternative<Timeout>(*error) ? timeouts : failures);
  }
};

}  // namespace coupler::host
