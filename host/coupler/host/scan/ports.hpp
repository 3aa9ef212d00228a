// SPDX-License-Identifier: Apache-2.0
// What a scan is given: the device to look at, and somebody to report to.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>

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

/// An unknown device. There are only functions that read, so that no scan can write. One request is in flight
/// at a time. After an error other than an exception the connection cannot be used: close() and connect()
/// follow.
class Client {
 public:
  virtual ~Client() = default;

  virtual Result<> connect() = 0;
  virtual void close() = 0;
  /// The unit of the next requests: 0 … 247, 255.
  virtual void select(std::uint8_t unit) = 0;
  /// FC 1 … 4: `range.count()` values (at most 2000 bits of 0 or 1, or 125 registers).
  virtual Result<> read(Table table, modbus::Range range, std::uint16_t* values) = 0;
  /// FC 43/14.
  virtual Result<IdentificationPage> identify(modbus::ReadDeviceIdentification wanted) = 0;
};

/// Gets the progress of a scan, and may end it.
class ScanProgress {
 public:
  virtual ~ScanProgress() = default;

  /// A step begins, as "unit ids" or "coils".
  virtual void begins(std::string_view step) = 0;
  /// Roughly `done` of `total` are done, with `requests` since the start.
  virtual void moved(std::uint32_t done, std::uint32_t total, std::uint64_t requests) = 0;
  /// Returns whether the scan has to end. Then no further request is sent.
  virtual bool wants_end() const = 0;
};

}  // namespace coupler::scan
