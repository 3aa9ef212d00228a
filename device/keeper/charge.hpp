// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "device/core/time.hpp"
#include "device/keeper/superior.hpp"
#include "device/net/open_connection.hpp"

namespace coupler::node {

/// What a keeper keeps, and what its I/O processes do with it. All but serve() is called in the keeper.
class Charge {
 public:
  /// The life of an I/O process: answers masters, beginning with `clients`, until a signal asks to stop or
  /// the superior to make room; then it gives the superior its clients. Returns the exit status.
  virtual int serve(Superior& superior, std::vector<OpenConnection> clients) = 0;

  /// Somebody asked to reload (SIGHUP). True: change() is to be called.
  virtual bool reload() = 0;
  /// Called every second or so. True: change() is to be called.
  virtual bool look_after(TimePoint now) = 0;
  /// There is no I/O process: what reload() or look_after() prepared comes into force. Outputs stay as they
  /// are. Closes those of the clients that have to find out.
  virtual void change(std::vector<OpenConnection>& clients) = 0;

  /// There is no I/O process, and nobody knows how it ended: drives the outputs to their safe state. False:
  /// one of them could not be driven.
  virtual bool make_safe() = 0;

 protected:
  ~Charge() = default;
};

}  // namespace coupler::node
