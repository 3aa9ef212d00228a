// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <vector>

#include "coupler/device/supervisor/child.hpp"
#include "coupler/device/supervisor/workload.hpp"

namespace coupler::device {

/// How long outputs may take to be driven to their safe state before those who do it are killed.
constexpr std::chrono::seconds safety_timeout{1};

/// Drives the outputs of the workload to their safe state while nobody else does: the hardware, and at the
/// same time what its firmware is behind if that is wanted, each in a process of its own. False: one could
/// not be driven, or took too long. A process that cannot be killed is added to `lost`.
bool make_safe(Workload& workload, bool firmware_too, std::vector<Child>& lost);

}  // namespace coupler::device
