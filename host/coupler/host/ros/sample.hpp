// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "coupler/host/core/stamp.hpp"

namespace coupler::host {

/// A value of a point, and how it is known.
struct Sample {
  Stamp stamp;
  bool is_told = false;  ///< the device announced it; otherwise it was read
  bool is_new = true;    ///< it differs from the value before, or there was none
};

}  // namespace coupler::host
