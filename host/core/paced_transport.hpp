// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/map/map.hpp"
#include "host/core/clock.hpp"
#include "host/core/transport.hpp"

namespace coupler::driver {

/// Keeps the pauses that some devices need: `connect_delay` after a connect, `request_gap` between a reply
/// and the next request.
class PacedTransport : public Transport {
 public:
  PacedTransport(Transport& transport, Clock& clock, const Limits& limits)
      : transport_(transport), clock_(clock), gap_(limits.request_gap), delay_(limits.connect_delay) {}

  Result<> connect() override;
  void close() override { transport_.close(); }
  void interrupt() override { transport_.interrupt(); }
  Result<> read_bits(Table table, modbus::Range range, std::uint8_t* bits) override;
  Result<> read_registers(Table table, modbus::Range range, std::uint16_t* registers) override;
  Result<> write_coil(std::uint16_t address, bool on) override;
  Result<> write_register(std::uint16_t address, std::uint16_t value) override;
  Result<> write_coils(std::uint16_t address, Span<const std::uint8_t> bits) override;
  Result<> write_registers(std::uint16_t address, Span<const std::uint16_t> registers) override;
  Result<> mask_write(std::uint16_t address, std::uint16_t and_mask, std::uint16_t or_mask) override;
  Result<> read_file_record(std::uint16_t file, std::uint16_t record, Span<std::uint16_t> registers) override;

 private:
  template <class Request>
  Result<> paced(Request&& request) {
    if (ready_ > Time::min() && clock_.now() < ready_) clock_.sleep_until(ready_);
    Result<> result = request();
    if (gap_ > Duration::zero()) ready_ = clock_.now() + gap_;
    return result;
  }

  Transport& transport_;
  Clock& clock_;
  Duration gap_;
  Duration delay_;
  Time ready_ = Time::min();  ///< no request before
};

}  // namespace coupler::driver
