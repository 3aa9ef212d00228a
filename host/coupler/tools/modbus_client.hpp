// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "coupler/host/modbus/make_links.hpp"
#include "coupler/host/scan/ports.hpp"

namespace coupler::tools {

/// FC 43/14.
host::Result<scan::IdentificationPage> read_identification(host::Link& link,
                                                           modbus::ReadDeviceIdentification wanted);

/// Returns what to do if a device cannot be reached: `over_tcp`, or what concerns an RTU line. It is empty if
/// the error itself says it, as that of a serial port that cannot be used.
std::string reach_remedy(const Connection& where, const host::Error& error, std::string_view over_tcp);

/// A scan's client.
class ModbusClient : public scan::Client {
 public:
  explicit ModbusClient(const Connection& where) : link_(host::make_link(where)), timeout_(where.timeout) {}

  host::Result<> connect() override { return link_.connect(); }
  void close() override { link_.close(); }
  void select(std::uint8_t unit) override { link_.select(unit, timeout_); }
  host::Result<> read(Table table, modbus::Range range, std::uint16_t* values) override {
    return link_.read(table, range, values);
  }
  host::Result<scan::IdentificationPage> identify(modbus::ReadDeviceIdentification wanted) override {
    return read_identification(link_, wanted);
  }

  /// From any thread: the request in progress and all later ones fail.
  void interrupt() { link_.interrupt(); }

 private:
  host::Link link_;
  std::chrono::milliseconds timeout_;
};

}  // namespace coupler::tools
