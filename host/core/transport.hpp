// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "common/base/span.hpp"
#include "common/map/table.hpp"
#include "common/modbus/range.hpp"
#include "host/core/error.hpp"

namespace coupler::driver {

/// The port to one unit of a Modbus device. Each request waits for its reply, at most for the device's
/// timeout. One thread calls it; only interrupt() may come from another.
class Transport {
 public:
  virtual ~Transport() = default;

  virtual Result<> connect() = 0;
  virtual void close() = 0;
  /// Ends the call in progress; it and every later one fail at once.
  virtual void interrupt() = 0;

  /// FC 1 or 2: `range.count()` (at most 2000) elements of 0 or 1.
  virtual Result<> read_bits(Table table, modbus::Range range, std::uint8_t* bits) = 0;
  /// FC 3 or 4: `range.count()` (at most 125) registers.
  virtual Result<> read_registers(Table table, modbus::Range range, std::uint16_t* registers) = 0;

  virtual Result<> write_coil(std::uint16_t address, bool on) = 0;                                   // FC 5
  virtual Result<> write_register(std::uint16_t address, std::uint16_t value) = 0;                   // FC 6
  virtual Result<> write_coils(std::uint16_t address, Span<const std::uint8_t> bits) = 0;            // FC 15
  virtual Result<> write_registers(std::uint16_t address, Span<const std::uint16_t> registers) = 0;  // FC 16
  /// FC 22: register = (register & and_mask) | (or_mask & ~and_mask), MAP 6.16.
  virtual Result<> mask_write(std::uint16_t address, std::uint16_t and_mask, std::uint16_t or_mask) = 0;
  /// FC 20 with one group: fills `registers` (1 … 121) from a file.
  virtual Result<> read_file_record(std::uint16_t file, std::uint16_t record,
                                    Span<std::uint16_t> registers) = 0;
};

}  // namespace coupler::driver
