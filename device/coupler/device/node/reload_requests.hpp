// SPDX-License-Identifier: Apache-2.0
// The reply to SIGHUP: the process that sent it may wait for the result of the reload, on a datagram socket
// that is named after its process id, which the node knows from the signal.
#pragma once

#include <sys/types.h>

#include <string>
#include <string_view>
#include <vector>

#include "coupler/device/log/stderr_log.hpp"

namespace coupler::device {

/// Processes that asked for the reload in progress.
class ReloadRequests {
 public:
  /// 0: an unknown process.
  void add(pid_t requester);
  /// Sends the result to those that wait for it, without waiting for them.
  void reply(bool taken, std::string_view text);

 private:
  std::vector<pid_t> all_;
};

/// `coupler-node --reload PID`: asks the node with that process id to read its map again, waits, and prints
/// what it answers. Returns the exit status: 0 the new map is served, 1 it is refused, 3 there is no such
/// node, or no answer.
int ask_to_reload(pid_t node, StderrLog& log);

}  // namespace coupler::device
