// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <memory>

#include "coupler/host/core/transport.hpp"
#include "coupler/host/modbus/wait.hpp"
#include "coupler/map/map.hpp"

namespace coupler::host {

/// A connection over which requests can go to any unit, one after the other, by Modbus/TCP or RTU. What is
/// right for a reply is the same over both.
class MultiUnitTransport : public Transport {
 public:
  /// The unit of the next requests, and how long their answers may take.
  virtual Result<> select(std::uint8_t unit, std::chrono::milliseconds timeout) = 0;
  /// connect() that ends when `interrupt` is set.
  virtual Result<> open(const Event& interrupt) = 0;
  /// From any thread: ends the request in progress; connect() is possible again.
  virtual void hang_up() = 0;
  /// Other units can be asked while the answer of one is late: only its own requests could take that for
  /// theirs.
  virtual bool is_bus() const { return false; }
  /// A request to the unit that was selected last would be sent without delay.
  virtual bool can_send() const { return true; }

  Result<modbus::Bytes> exchange(modbus::Bytes pdu) override;
  Result<modbus::Bytes> receive_pdu() override;

 protected:
  /// The PDU of the request in progress.
  virtual modbus::Bytes sent() const = 0;
  /// The PDU that has come in answer to it.
  virtual Result<modbus::Bytes> receive_reply() = 0;
  /// That came, or was looked at, after its time.
  virtual bool is_late() const = 0;
  virtual std::chrono::milliseconds timeout() const = 0;
};

/// What `connection` needs.
std::unique_ptr<MultiUnitTransport> make_transport(const Connection& connection);

}  // namespace coupler::host
