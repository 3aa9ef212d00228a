// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace coupler::host {

/// "process 1234 (coupler_driver)", another one that has the device file open; empty: none that this user may
/// look at.
std::string holder_of(const std::string& device);

}  // namespace coupler::host
