// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <mutex>
#include <string>

#include "common/map/map.hpp"
#include "host/core/transport.hpp"
#include "host/modbus/event.hpp"

struct _modbus;  // NOLINT(bugprone-reserved-identifier): libmodbus's name for its context

namespace coupler::driver {

/// One unit of a Modbus/TCP device, by libmodbus. It connects by itself, since libmodbus's connect can be
/// neither interrupted nor made to resolve names in the background.
class ModbusTransport : public Transport {
 public:
  explicit ModbusTransport(const Connection& connection);
  ~ModbusTransport() override;
  ModbusTransport(const ModbusTransport&) = delete;
  ModbusTransport& operator=(const ModbusTransport&) = delete;

  Result<> connect() override;
  void close() override;
  void interrupt() override;
  Result<> read_bits(Table table, modbus::Range range, std::uint8_t* bits) override;
  Result<> read_registers(Table table, modbus::Range range, std::uint16_t* registers) override;
  Result<> write_coil(std::uint16_t address, bool on) override;
  Result<> write_register(std::uint16_t address, std::uint16_t value) override;
  Result<> write_coils(std::uint16_t address, Span<const std::uint8_t> bits) override;
  Result<> write_registers(std::uint16_t address, Span<const std::uint16_t> registers) override;
  Result<> mask_write(std::uint16_t address, std::uint16_t and_mask, std::uint16_t or_mask) override;
  Result<> read_file_record(std::uint16_t file, std::uint16_t record, Span<std::uint16_t> registers) override;

 private:
  /// What a libmodbus call that should return `expected` came to.
  Result<> result(int returned, std::uint32_t expected) const;

  std::string host_;
  std::uint16_t port_;
  std::uint8_t unit_;
  std::chrono::milliseconds timeout_;
  std::unique_ptr<_modbus, void (*)(_modbus*)> context_;
  Event interrupted_;
  std::mutex socket_mutex_;  ///< between closing the socket and interrupt(); never held during a request
  int socket_ = -1;
};

}  // namespace coupler::driver
