// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <memory>

#include "coupler/host/core/transport.hpp"
#include "coupler/host/modbus/wait.hpp"
#include "coupler/map/map.hpp"
#include "coupler/modbus/client.hpp"

namespace coupler::host {

/// A connection over which requests can go to any unit, one after the other. It carries a PDU and brings that
/// of the reply, over Modbus/TCP or RTU; what they mean is the same over both.
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

  /// Sends any PDU. Returns that of the reply, which may be an exception, valid until the next request.
  virtual Result<modbus::Bytes> exchange(modbus::Bytes pdu);

  Result<> read_bits(Table table, modbus::Range range, std::uint8_t* bits) override;
  Result<> read_registers(Table table, modbus::Range range, std::uint16_t* registers) override;
  Result<> read_file_record(std::uint16_t file, std::uint16_t record, Span<std::uint16_t> registers) override;
  Result<> send(const modbus::WriteRequest& request) override { return send_pdu(request.pdu()); }
  Result<> receive(const modbus::WriteRequest& request) override;

 protected:
  /// exchange() of a request that reads.
  virtual Result<modbus::Bytes> ask(const modbus::ReadRequest& request) { return exchange(request.pdu()); }
  // The two halves of exchange().
  virtual Result<> send_pdu(modbus::Bytes pdu) = 0;
  virtual Result<modbus::Bytes> receive_pdu() = 0;
};

/// What `connection` needs.
std::unique_ptr<MultiUnitTransport> make_transport(const Connection& connection);

}  // namespace coupler::host
