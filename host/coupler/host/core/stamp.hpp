// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "coupler/host/core/clock.hpp"

namespace coupler::host {

/// When a value was true: between `at` - `uncertainty` and `at` + `uncertainty`.
struct Stamp {
  Time at{};
  Duration uncertainty{};
};

/// Of a value that a device told between a request and its reply: the middle, and half of the distance.
inline Stamp stamp_between(Time sent, Time received) {
  const Duration half = (received - sent) / 2;
  return {sent + half, received - sent - half};  // the greater half
}

}  // namespace coupler::host
