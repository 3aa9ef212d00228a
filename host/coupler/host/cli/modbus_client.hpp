// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "coupler/host/modbus/multi_unit_transport.hpp"
#include "coupler/host/scan/ports.hpp"

namespace coupler::cli {

/// FC 43/14.
host::Result<scan::IdentificationPage> read_identification(host::MultiUnitTransport& transport,
                                                           modbus::ReadDeviceIdentification wanted);

/// Returns what to do if a device cannot be reached: `over_tcp`, or what concerns an RTU line. It is empty if
/// the error itself says it, as that of a serial port that cannot be used.
std::string reach_remedy(const Connection& where, const host::Error& error, std::string_view over_tcp);

/// A scan's client.
class ModbusClient : public scan::Client {
 public:
  explicit ModbusClient(const Connection& where)
      : transport_(host::make_transport(where)), timeout_(where.timeout) {}

  host::Result<> connect() override { return transport_->connect(); }
  void close() override { transport_->close(); }
  void select(std::uint8_t unit) override { transport_->select(unit, timeout_); }
  host::Result<> read(Table table, modbus::Range range, std::uint16_t* values) override {
    return transport_->read(table, range, values);
  }
  host::Result<scan::IdentificationPage> identify(modbus::ReadDeviceIdentification wanted) override {
    return read_identification(*transport_, wanted);
  }

  /// From any thread: the request in progress and all later ones fail.
  void interrupt() { transport_->interrupt(); }

 private:
  std::unique_ptr<host::MultiUnitTransport> transport_;
  std::chrono::milliseconds timeout_;
};

}  // namespace coupler::cli
