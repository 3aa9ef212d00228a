// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "coupler/device/supervisor/child.hpp"

namespace coupler::device {

/// The result for outputs that were to go to their safe state.
enum class SafeOutcome : std::uint8_t {
  safe,
  failed,   ///< one of them could not be driven, or the process for them died
  hangs,    ///< that process took too long and was killed
  unasked,  ///< there was no process to be had for them
};

/// Works that are done at the same time, each in a process of its own: one that hangs costs nothing but
/// itself. Each may take as long as a worker process may be silent; these times run together.
class SafetyProcesses {
 public:
  /// A process that cannot be killed is added to `lost`.
  explicit SafetyProcesses(std::vector<Child>& lost);
  SafetyProcesses(const SafetyProcesses&) = delete;
  SafetyProcesses& operator=(const SafetyProcesses&) = delete;
  ~SafetyProcesses();

  /// `work` returns false if an output could not be driven. False: there is no process to be had for it.
  bool start(const std::function<bool()>& work);
  /// Waits for all of them. The outcomes are in the order of the works.
  std::vector<SafeOutcome> finish();

 private:
  class Process;

  std::vector<Child>& lost_;
  std::vector<SafeOutcome> outcomes_;
  std::vector<Process> processes_;
};

}  // namespace coupler::device
