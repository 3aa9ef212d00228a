// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/core/point_quality.hpp"

namespace coupler::host {

using State = PointQuality::State;

std::string_view to_string(State state) {
  switch (state) {
    case State::good: return "good";
    case State::stale: return "stale";
    case State::never_read: return "never read";
    case State::exception: return "exception";
    case State::rejected: return "rejected";
    case State::offline: return "offline";
    case State::not_wanted: return "not wanted";
    case State::invalid: return "invalid";
    case State::fault: return "fault";
  }
  return "?";
}

}  // namespace coupler::host
