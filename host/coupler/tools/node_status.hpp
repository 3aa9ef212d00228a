// SPDX-License-Identifier: Apache-2.0
// What a node says about itself at one moment: asking for it, and showing it.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>

#include "coupler/host/core/link.hpp"
#include "coupler/host/scan/ports.hpp"
#include "coupler/map/identity.hpp"
#include "coupler/map/map.hpp"

namespace coupler::tools {

struct NodeStatus {
  std::chrono::system_clock::time_point at{};
  std::optional<host::Error> error{};        ///< why not everything could be asked; nullopt: it was
  std::optional<identity::Report> report{};  ///< nullopt: a foreign coupler, or no answer
  identity::Further further{};               ///< as far as the node says
  std::map<std::uint8_t, std::string> identification{};  ///< the objects of FC 43/14
  std::optional<host::Certificates> certificates{};      ///< of a connection with TLS
};

/// FC 43/14 over the same connection.
using Identify =
    std::function<host::Result<scan::IdentificationPage>(modbus::ReadDeviceIdentification wanted)>;

/// Reads all of it, over a connection of its own, which is then closed. If the device ignores the request for
/// the identity area, as some foreign couplers do, the rest is read over another connection.
NodeStatus read_status(host::Link& link, const Identify& identify);

/// Returns lines for people. For a foreign coupler they are its identification; empty if it has none. Texts
/// of the device are made harmless for a terminal.
std::string status_text(const NodeStatus& status, const Connection& where);

/// One line of JSON. docs/commands.md has a table of its fields.
std::string status_json(const NodeStatus& status, const Connection& where);

}  // namespace coupler::tools
