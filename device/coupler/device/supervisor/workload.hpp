// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <vector>

#include "coupler/device/core/time.hpp"
#include "coupler/device/net/open_connection.hpp"
#include "coupler/device/supervisor/supervisor_link.hpp"

namespace coupler::device {

/// What a supervisor keeps, and what its worker processes do with it. It is called in the supervisor unless
/// it says otherwise, and waits for nothing there.
class Workload {
 public:
  /// The life of a worker process: answers clients, beginning with `clients`, until a signal asks to stop or
  /// the supervisor to make room; then it gives the supervisor its clients. After a signal it tries to leave
  /// its outputs in their safe state. Returns the exit status: 0 if it was asked to end.
  virtual int serve(SupervisorLink& supervisor, std::vector<OpenConnection> clients) = 0;

  /// That process (0: unknown) asked to reload, by SIGHUP. look_after() tells when it is done.
  virtual void reload(pid_t asker) = 0;
  /// Called every 100 ms or so. True: change() is to be called.
  virtual bool look_after(TimePoint now) = 0;
  /// There is no worker process: what reload() or look_after() prepared comes into force. Outputs stay as
  /// they are. Closes those of the clients that have to find out.
  virtual void change(std::vector<OpenConnection>& clients) = 0;

  /// There is no worker process. Drives the outputs to their safe state, in a process of its own, since lines
  /// can hang; in the supervisor if there is none to be had. False: one of them could not be driven.
  virtual bool drive_safe() = 0;
  /// The same for what a firmware's code is behind, never in the supervisor.
  virtual bool make_firmware_safe() = 0;
  virtual bool has_firmware() const = 0;

 protected:
  ~Workload() = default;
};

}  // namespace coupler::device
