// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "coupler/device/core/statistics.hpp"

namespace coupler::device {

/// The last line of a process that answered clients, which `signal` stopped: `safe` says whether all outputs
/// are in their safe state. Statistics that are 0 are left out, but for requests and their exceptions.
std::string shutdown_summary(int signal, bool safe, const Statistics& statistics, TimePoint now);

}  // namespace coupler::device
