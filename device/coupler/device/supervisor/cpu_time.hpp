// SPDX-License-Identifier: Apache-2.0
// How long another process has waited for the CPU. One that gets none is not one that hangs: whoever watches
// its heartbeat deducts this time.
#pragma once

#include <sys/types.h>

#include <chrono>

#include "coupler/base/descriptor.hpp"
#include "coupler/device/core/time.hpp"

namespace coupler::device {

/// The times that the kernel reports for the main thread of a process.
struct CpuTimes {
  std::chrono::nanoseconds ran{0};
  /// Ready to run without a CPU. The kernel adds a wait only when it ends.
  std::chrono::nanoseconds waited{0};
  bool is_runnable = false;  ///< it runs now, or waits for the CPU
};

/// The time that a process has waited for the CPU, with the wait that has not ended.
class WaitEstimate {
 public:
  /// Adds a look at the process; returns the whole time. It may become less: what was taken for a wait gives
  /// way to what the kernel counts in the end.
  std::chrono::nanoseconds add(const CpuTimes& times, TimePoint now);

 private:
  CpuTimes last_;
  TimePoint looked_{};
  /// Since the kernel last counted anything. Replaced by what it counts, not added to it.
  std::chrono::nanoseconds provisional_{0};
};

/// Looks at one process. It keeps two files of /proc open, so a process that gets the same number later is
/// not taken for it.
class CpuWait {
 public:
  /// If the kernel does not count waits (no SCHED_INFO), or the files cannot be read, no time passes.
  explicit CpuWait(pid_t pid);

  /// Returns whether the kernel counts waits, and the process could be looked at when this object was made.
  bool is_counted() const { return schedstat_.is_open() && stat_.is_open(); }
  /// The time that its main thread has waited for the CPU in its life.
  std::chrono::nanoseconds sample(TimePoint now);

 private:
  Descriptor schedstat_;
  Descriptor stat_;
  WaitEstimate estimate_;
  std::chrono::nanoseconds waited_{0};
};

}  // namespace coupler::device
