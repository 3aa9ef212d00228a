// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <list>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "coupler/device/core/log.hpp"
#include "coupler/device/core/server.hpp"
#include "coupler/device/net/tcp_server.hpp"
#include "coupler/device/net/timer.hpp"
#include "coupler/device/node/serving_context.hpp"

namespace coupler::device {

/// Answers clients with the hardware of a map.
class IoService {
 public:
  /// All of them outlive it. The context is in force. `clients`: where another process hands over those that
  /// it has let in (send_client()); -1: none does.
  IoService(const ServingContext& context, Loop& loop, Log& log, int clients = -1);
  IoService(const IoService&) = delete;
  IoService& operator=(const IoService&) = delete;
  ~IoService();

  /// Continues with clients that another service released.
  void take_over(std::vector<OpenConnection> clients);
  /// Serves until `is_over`, which is called in each turn of the loop, is true. Calls `beat` once in each
  /// heartbeat_period.
  void run(const std::function<bool(TimePoint)>& is_over, const std::function<void()>& beat);
  /// Releases its clients; outputs stay as they are, and what clients have scheduled is cancelled.
  std::vector<OpenConnection> release();
  /// The end: drives the outputs to their safe state, tells those that wait for changes, and logs why the
  /// node ends, and the summary.
  void end(std::string_view why);
  /// Drives the outputs to their safe state, and tells those that wait for changes. False: one of them could
  /// not be driven.
  bool make_safe(modbus::Reason reason);

 private:
  class EdgeHandler;
  class Intake;

  void turn();
  void tell_firmware();
  void log_trips();

  Loop& loop_;
  Log& log_;
  std::list<EdgeHandler> edge_handlers_;
  const Statistics& statistics_;
  HookedPoints* hooked_;  ///< null: no firmware's code is behind points
  std::vector<ChangeRing::Entry> ring_;
  std::vector<std::uint16_t> told_;
  Changes changes_;
  OutputSchedule schedule_;
  Handler handler_;
  Server server_;
  TcpServer tcp_;
  std::unique_ptr<Intake> intake_;  ///< null: of no clients
  Timer timer_;                     ///< for what is scheduled
  TimePoint now_;
  std::uint32_t trips_;  ///< of the watchdog, that were logged
};

/// The lines that a process that answered clients logs at its end. `why` is the reason for the end. `safe`:
/// all outputs are in their safe state. Statistics that are 0 are left out, except requests and their
/// exceptions.
std::string shutdown_summary(std::string_view why, bool safe, const Statistics& statistics, TimePoint now);

}  // namespace coupler::device
