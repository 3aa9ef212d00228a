// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>

namespace coupler::device {

/// The node's only clock; who needs the time is given it.
using TimePoint = std::chrono::steady_clock::time_point;

}  // namespace coupler::device
