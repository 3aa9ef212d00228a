// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "coupler/device/core/server.hpp"
#include "coupler/device/node/shared_state.hpp"

namespace coupler::device {

/// The core of a node on the state that it is given.
class Node {
 public:
  /// All of them outlive the node; the state is of this map.
  Node(const Map& map, Hardware hardware, SharedState& state)
      : handler_(map, state.image(), hardware, state.statistics(), state.watchdog(), state.links()),
        server_(map.connection.unit, handler_, state.statistics()) {
    handler_.set_machine(state.machine());
  }

  Handler& handler() { return handler_; }
  Server& server() { return server_; }

 private:
  Handler handler_;
  Server server_;
};

}  // namespace coupler::device
