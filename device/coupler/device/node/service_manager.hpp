// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <utility>

#include "coupler/device/core/time.hpp"
#include "coupler/device/net/descriptor.hpp"
#include "coupler/device/supervisor/heartbeat.hpp"

namespace coupler::device {

/// Tells systemd how the node is, in the protocol of sd_notify(3): a datagram for each piece of news. Why it
/// does without libsystemd: docs/decisions/0006-sd-notify-without-libsystemd.md.
class ServiceManager : public Heartbeat {
 public:
  /// The values of NOTIFY_SOCKET and WATCHDOG_USEC; null: nobody wants to know.
  ServiceManager(const char* socket, const char* watchdog);

  bool is_there() const { return socket_.is_open(); }

  /// What it is told with the first sign of life.
  void set_status(std::string status) { status_ = std::move(status); }
  /// The first one: ready, with the status. Later ones keep the manager's watchdog from killing the node, at
  /// twice the rate that it asks for. Never blocks.
  void beat() override;
  /// A new map is being read; ready() tells how that ended.
  void reloading(TimePoint now);
  void ready(std::string status);
  void stopping();

 private:
  void send(std::string_view news);

  Descriptor socket_;
  std::string status_;
  bool is_ready_ = false;
  unsigned interval_ = 0;  ///< beats between two that are passed on; 0: none are
  unsigned beats_ = 0;     ///< since the last one
};

}  // namespace coupler::device
