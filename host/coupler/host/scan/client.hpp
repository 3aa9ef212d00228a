// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "coupler/host/core/error.hpp"
#include "coupler/map/table.hpp"
#include "coupler/modbus/device_identification.hpp"
#include "coupler/modbus/range.hpp"

namespace coupler::scan {

using host::Result;

/// One reply to FC 43/14.
struct IdentificationPage {
  std::map<std::uint8_t, std::string> objects;
  std::optional<std::uint8_t> next;  ///< where the stream goes on
};

/// The port to a device that nobody knows. It reads and does nothing else, so that no scan can write. One
/// request is in flight at a time. An error other than an exception reply leaves the connection unusable:
/// close() and connect() follow.
class Client {
 public:
  virtual ~Client() = default;

  virtual Result<> connect() = 0;
  virtual void close() = 0;
  /// Whom the next requests are for: 0 … 247, 255.
  virtual void select(std::uint8_t unit) = 0;
  /// FC 1 … 4: `range.count()` values (at most 2000 bits of 0 or 1, or 125 registers).
  virtual Result<> read(Table table, modbus::Range range, std::uint16_t* values) = 0;
  /// FC 43/14.
  virtual Result<IdentificationPage> identify(modbus::ReadDeviceIdentification wanted) = 0;
};

}  // namespace coupler::scan
