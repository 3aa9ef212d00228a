// SPDX-License-Identifier: Apache-2.0
#include "host/core/paced_transport.hpp"

namespace coupler::driver {

Result<> PacedTransport::connect() {
  Result<> result = transport_.connect();
  ready_ = delay_ > Duration::zero() ? clock_.now() + delay_ : Time::min();
  return result;
}

Result<> PacedTransport::read_bits(Table table, modbus::Range range, std::uint8_t* bits) {
  return paced([&] { return transport_.read_bits(table, range, bits); });
}
Result<> PacedTransport::read_registers(Table table, modbus::Range range, std::uint16_t* registers) {
  return paced([&] { return transport_.read_registers(table, range, registers); });
}
Result<> PacedTransport::write_coil(std::uint16_t address, bool on) {
  return paced([&] { return transport_.write_coil(address, on); });
}
Result<> PacedTransport::write_register(std::uint16_t address, std::uint16_t value) {
  return paced([&] { return transport_.write_register(address, value); });
}
Result<> PacedTransport::write_coils(std::uint16_t address, Span<const std::uint8_t> bits) {
  return paced([&] { return transport_.write_coils(address, bits); });
}
Result<> PacedTransport::write_registers(std::uint16_t address, Span<const std::uint16_t> registers) {
  return paced([&] { return transport_.write_registers(address, registers); });
}
Result<> PacedTransport::mask_write(std::uint16_t address, std::uint16_t and_mask, std::uint16_t or_mask) {
  return paced([&] { return transport_.mask_write(address, and_mask, or_mask); });
}
Result<> PacedTransport::read_file_record(std::uint16_t file, std::uint16_t record,
                                          Span<std::uint16_t> registers) {
  return paced([&] { return transport_.read_file_record(file, record, registers); });
}

}  // namespace coupler::driver
