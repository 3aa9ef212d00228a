// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "coupler/device/core/time.hpp"
#include "coupler/map/identity.hpp"

namespace coupler::device {

/// Counts since the start.
struct Statistics : identity::Counts {
  TimePoint started{};
};

}  // namespace coupler::device
