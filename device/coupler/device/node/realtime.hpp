// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <tl/expected.hpp>

namespace coupler::device {

/// Priorities of SCHED_FIFO under --realtime. Both are above every ordinary program, and below the kernel's
/// threads for interrupts (50), which bring requests and edges. The supervisor's is the higher one: on a
/// board with one processor it would otherwise never get to end a worker process that has run wild.
enum class RealtimePriority : int { worker = 10, supervisor = 11 };

/// Puts the calling thread ahead of ordinary programs and locks the memory of its process, so that neither
/// load nor swapping delays it. Each process of a node calls it for itself, before it starts threads: threads
/// and processes that are started later have ordinary priority again, since they may be a firmware's code,
/// which nobody has asked to be that urgent. The error says what was refused and what to do, one a line.
tl::expected<void, std::string> become_realtime(RealtimePriority priority);

/// The first half alone, for a process that drives outputs to their safe state and ends. False: refused.
bool take_priority(RealtimePriority priority);

}  // namespace coupler::device
