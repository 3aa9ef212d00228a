// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "coupler/host/core/clock.hpp"

namespace coupler::host {

/// The time at which a value was true: between `at` - `uncertainty` and `at` + `uncertainty`.
struct Stamp {
  Time at{};
  Duration uncertainty{};
};

/// The stamp of a value that a device read between a request and its reply: the middle of the two times, and
/// half of their distance.
inline Stamp stamp_between(Time sent, Time received) {
  const Duration half = (received - sent) / 2;
  return {sent + half, received - sent - half};  // the greater half
}

}  // namespace coupler::host
