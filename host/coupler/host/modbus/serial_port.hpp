// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "coupler/host/core/error.hpp"
#include "coupler/host/core/wakeup.hpp"
#include "coupler/map/serial.hpp"

struct _modbus;  // NOLINT(bugprone-reserved-identifier): libmodbus's name for its context

namespace coupler::host {

/// A serial port that is this process's own (flock, TIOCEXCL), open and set by libmodbus. It has its former
/// settings again when it is closed.
class SerialPort {
 public:
  /// Errors: NotConnected, which says what to do: no such port, no permission, held by another process, a
  /// setting that the port refuses.
  static Result<SerialPort> open(const Serial& settings);

  /// Non-blocking.
  int fd() const;

 private:
  using Context = std::unique_ptr<_modbus, void (*)(_modbus*)>;
  SerialPort(Descriptor lock, Context context) : lock_(std::move(lock)), context_(std::move(context)) {}

  Descriptor lock_;  ///< locked before libmodbus sets anything
  Context context_;
};

}  // namespace coupler::host
