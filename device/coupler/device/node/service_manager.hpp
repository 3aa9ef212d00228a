// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <utility>

#include "coupler/base/descriptor.hpp"
#include "coupler/device/core/time.hpp"

namespace coupler::device {

/// Reports the node's state to systemd, in the protocol of sd_notify(3): a datagram for each change. Why it
/// does without libsystemd: docs/decisions/0006-sd-notify-without-libsystemd.md.
class ServiceManager {
 public:
  /// The values of NOTIFY_SOCKET and WATCHDOG_USEC; null: there is no service manager.
  ServiceManager(const char* socket, const char* watchdog);

  bool is_there() const { return socket_.is_open(); }

  /// The state that the first beat() reports.
  void set_status(std::string status) { status_ = std::move(status); }
  /// The node's loop turns. The first call reports that the node is ready, with the status. Later ones feed
  /// the manager's watchdog, at twice the rate that it asks for. Never blocks.
  void beat();
  /// A new map is being read, until ready() is called.
  void reloading(TimePoint now);
  void ready(std::string status);
  void stopping();

 private:
  void send(std::string_view state);

  Descriptor socket_;
  std::string status_;
  bool is_ready_ = false;
  unsigned interval_ = 0;  ///< beats between two that are passed on; 0: none are
  unsigned beats_ = 0;     ///< since the last one
};

}  // namespace coupler::device
