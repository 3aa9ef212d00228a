// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "coupler/device/core/server.hpp"
#include "coupler/device/node/memory.hpp"

namespace coupler::device {

/// The core of a node on the memory that it is given.
class Node {
 public:
  /// All of them outlive the node; the memory is of this map.
  Node(const Map& map, Hardware hardware, Memory& memory)
      : handler_(map, memory.image(), hardware, memory.statistics(), memory.watchdog(), memory.links()),
        server_(map.connection.unit, handler_, memory.statistics()) {
    handler_.set_machine(memory.machine());
  }

  Handler& handler() { return handler_; }
  Server& server() { return server_; }

 private:
  Handler handler_;
  Server server_;
};

}  // namespace coupler::device
