// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <functional>
#include <vector>

#include "coupler/device/core/log.hpp"
#include "coupler/device/net/tcp_server.hpp"
#include "coupler/device/node/edge_watcher.hpp"
#include "coupler/device/node/node.hpp"
#include "coupler/device/node/serving_context.hpp"
#include "coupler/device/supervisor/heartbeat.hpp"

namespace coupler::device {

/// Answers clients with the hardware of a map.
class IoService {
 public:
  /// All of them outlive it. The context is in force.
  IoService(const ServingContext& context, Loop& loop, Log& log);

  /// Goes on with clients that another one let go.
  void take_over(std::vector<OpenConnection> clients);
  /// Serves until `is_over`, asked at each turn, says so. `heartbeat` is told that the loop turns.
  void run(const std::function<bool(TimePoint)>& is_over, Heartbeat& heartbeat);
  /// Lets go of its clients, outputs as they are.
  std::vector<OpenConnection> release();
  /// The end after a signal: drives the outputs to their safe state and says what there was.
  void end(int signal);
  /// Drives them there for another reason. False: one of them could not be driven.
  bool make_safe() { return hardware_.drive_safe(); }

 private:
  void turn();
  void log_trips();

  Hardware hardware_;
  Loop& loop_;
  Log& log_;
  std::deque<EdgeWatcher> watchers_;
  const Statistics& statistics_;
  Node node_;
  TcpServer tcp_;
  TimePoint now_;
  std::uint32_t trips_;  ///< of the watchdog, in the log
};

}  // namespace coupler::device
