// SPDX-License-Identifier: Apache-2.0
// What a node says of itself, at one moment.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>

#include "coupler/host/core/transport.hpp"
#include "coupler/host/scan/client.hpp"
#include "coupler/map/identity.hpp"

namespace coupler::cli {

struct NodeStatus {
  std::chrono::system_clock::time_point at{};
  std::string trouble{};                                 ///< why not everything could be asked; empty: it was
  std::optional<identity::Report> report{};              ///< nullopt: a foreign coupler, or no answer
  identity::Machine machine{};                           ///< as far as the node says
  std::map<std::uint8_t, std::string> identification{};  ///< the objects of FC 43/14
};

/// FC 43/14 over the same connection.
using Identify =
    std::function<host::Result<scan::IdentificationPage>(modbus::ReadDeviceIdentification wanted)>;

/// Asks for all of it, over a connection of its own, which is closed then. A device that ignores the question
/// for the identity area, as some foreign couplers do, is asked for the rest over another one.
NodeStatus read_status(host::Transport& transport, const Identify& identify);

}  // namespace coupler::cli
