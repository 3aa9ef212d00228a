// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "coupler/device/supervisor/child.hpp"

namespace coupler::device {

/// What became of outputs that were to go to their safe state.
enum class SafeOutcome : std::uint8_t {
  safe,
  failed,   ///< one of them could not be driven, or the process for them died
  hangs,    ///< that process took too long and was killed
  unasked,  ///< there was no process to be had for them
};

/// Does all of the works at the same time, each in a process of its own: one that hangs costs nothing but
/// itself. A work returns false if an output could not be driven. Each may take as long as a worker process
/// may be silent; these times run together. Returns the outcomes in the order of the works. A process that
/// cannot be killed is added to `lost`.
std::vector<SafeOutcome> drive_apart(const std::vector<std::function<bool()>>& works,
                                     std::vector<Child>& lost);

}  // namespace coupler::device
