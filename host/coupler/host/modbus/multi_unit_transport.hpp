// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <memory>

#include "coupler/host/core/transport.hpp"
#include "coupler/host/modbus/wait.hpp"
#include "coupler/map/map.hpp"

namespace coupler::host {

/// A connection that carries requests to any unit, one after the other, by Modbus/TCP or RTU. A reply has to
/// pass the same checks over both.
class MultiUnitTransport : public Transport {
 public:
  /// Sets the unit of the next requests, and the time within which it must reply.
  virtual Result<> select(std::uint8_t unit, std::chrono::milliseconds timeout) = 0;
  /// connect() that ends when `interrupt` is set.
  virtual Result<> open(const Event& interrupt) = 0;
  /// Ends the request in progress. connect() is possible again. Any thread may call it.
  virtual void hang_up() = 0;
  /// Returns true if other units can be asked while the reply of one unit is late, because its late reply can
  /// only be taken for the reply to another request to the same unit.
  virtual bool is_bus() const { return false; }
  /// Returns whether a request to the selected unit would be sent without delay.
  virtual bool can_send() const { return true; }

  Result<modbus::Bytes> exchange(modbus::Bytes pdu) override;
  Result<modbus::Bytes> receive_pdu() override;

 protected:
  /// The PDU of the request in progress.
  virtual modbus::Bytes sent() const = 0;
  /// Waits for the PDU of its reply.
  virtual Result<modbus::Bytes> receive_reply() = 0;
  /// Returns whether that reply came, or was looked at, after the timeout.
  virtual bool is_late() const = 0;
  virtual std::chrono::milliseconds timeout() const = 0;
};

/// Makes the kind of connection that `connection` describes.
std::unique_ptr<MultiUnitTransport> make_transport(const Connection& connection);

}  // namespace coupler::host
