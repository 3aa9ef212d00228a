// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "coupler/host/core/transport.hpp"
#include "coupler/host/ros/log.hpp"

namespace coupler::host {

/// Shows each request at ROS's debug level: what it was, its result, and how long it took. Knows when the
/// last one began.
class TracedTransport : public Transport {
 public:
  TracedTransport(std::string name, std::unique_ptr<Transport> transport, Log& log)
      : name_(std::move(name)), transport_(std::move(transport)), log_(log) {}

  /// Of the last read, in its thread.
  Time asked() const { return asked_; }

  Result<> connect() override;
  void close() override { transport_->close(); }
  void interrupt() override { transport_->interrupt(); }
  Result<> read_bits(Table table, modbus::Range range, std::uint8_t* bits) override;
  Result<> read_registers(Table table, modbus::Range range, std::uint16_t* registers) override;
  Result<> read_file_record(std::uint16_t file, std::uint16_t record, Span<std::uint16_t> registers) override;
  void rank(Rank rank) override { transport_->rank(rank); }
  Turn await_turn(Time until, bool write_waits = false) override {
    return transport_->await_turn(until, write_waits);
  }
  bool reserve() override { return transport_->reserve(); }
  Result<> send(const modbus::WriteRequest& request) override;
  Result<> receive(const modbus::WriteRequest& request) override;
  Woken wait_until(Time time) override { return transport_->wait_until(time); }
  void wake() override { transport_->wake(); }

 private:
  template <class Describe>
  Result<> told(Result<> result, Time begun, Describe describe);

  std::string name_;
  std::unique_ptr<Transport> transport_;
  Log& log_;
  Time asked_{};
  Time sent_{};
};

}  // namespace coupler::host
