// SPDX-License-Identifier: Apache-2.0
// The answer to SIGHUP: who sends it may wait to hear whether the map was taken. It listens on a datagram
// socket that is named after its process id, which the node knows from the signal.
#pragma once

#include <sys/types.h>

#include <string>
#include <string_view>
#include <vector>

#include "coupler/device/node/stderr_log.hpp"

namespace coupler::device {

/// Processes that asked for the reload that is going on.
class Askers {
 public:
  /// 0 is nobody.
  void add(pid_t asker);
  /// Those who wait for it hear how it ended; nobody is waited for.
  void tell(bool taken, std::string_view text);

 private:
  std::vector<pid_t> all_;
};

/// `coupler-node --reload PID`: asks the node with that process id to read its map again, waits, and prints
/// what it answers. Returns the exit status: 0 the new map is served, 1 it is refused, 3 there is no such
/// node, or no answer.
int ask_to_reload(pid_t node, StderrLog& log);

}  // namespace coupler::device
