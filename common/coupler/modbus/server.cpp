// SPDX-License-Identifier: Apache-2.0
#include "coupler/modbus/server.hpp"

#include <cassert>
#include <cstring>

#include "coupler/modbus/limits.hpp"

namespace coupler::modbus {
namespace {

using Parsed = tl::expected<Request, Exception>;

constexpr auto bad_value = Exception::illegal_data_value;
constexpr auto bad_address = Exception::illegal_data_address;

/// FC 5 says ON with 0xFF00; one packed bit says it with 1.
constexpr std::uint8_t packed_off[]{0};
constexpr std::uint8_t packed_on[]{1};

Parsed parse_read(Function function, Bytes pdu, std::uint16_t limit) {
  if (pdu.size() != 5) return tl::unexpected(bad_value);
  const std::uint16_t quantity = get_u16(&pdu[3]);
  if (quantity == 0 || quantity > limit) return tl::unexpected(bad_value);
  const auto range = Range::make(get_u16(&pdu[1]), quantity);
  if (!range) return tl::unexpected(bad_address);
  return Read{function, *range};
}

Parsed parse_write_coil(Bytes pdu) {
  if (pdu.size() != 5) return tl::unexpected(bad_value);
  const std::uint16_t value = get_u16(&pdu[3]);
  if (value != 0x0000 && value != 0xFF00) return tl::unexpected(bad_value);
  return WriteBits{Range::of(get_u16(&pdu[1]), 1), value == 0 ? packed_off : packed_on};
}

Parsed parse_write_register(Bytes pdu) {
  if (pdu.size() != 5) return tl::unexpected(bad_value);
  return WriteRegisters{Range::of(get_u16(&pdu[1]), 1), pdu.sub(3, 2)};
}

Parsed parse_write_coils(Bytes pdu) {
  if (pdu.size() < 6) return tl::unexpected(bad_value);
  const std::uint16_t quantity = get_u16(&pdu[3]);
  if (quantity == 0 || quantity > max_write_bits) return tl::unexpected(bad_value);
  if (pdu[5] != (quantity + 7) / 8 || pdu.size() != std::size_t{6} + pdu[5]) return tl::unexpected(bad_value);
  const auto range = Range::make(get_u16(&pdu[1]), quantity);
  if (!range) return tl::unexpected(bad_address);
  return WriteBits{*range, pdu.from(6)};
}

Parsed parse_write_registers(Bytes pdu) {
  if (pdu.size() < 6) return tl::unexpected(bad_value);
  const std::uint16_t quantity = get_u16(&pdu[3]);
  if (quantity == 0 || quantity > max_write_registers) return tl::unexpected(bad_value);
  if (pdu[5] != 2 * quantity || pdu.size() != std::size_t{6} + pdu[5]) return tl::unexpected(bad_value);
  const auto range = Range::make(get_u16(&pdu[1]), quantity);
  if (!range) return tl::unexpected(bad_address);
  return WriteRegisters{*range, pdu.from(6)};
}

Parsed parse_mask_write(Bytes pdu) {
  if (pdu.size() != 7) return tl::unexpected(bad_value);
  return MaskWrite{Range::of(get_u16(&pdu[1]), 1), get_u16(&pdu[3]), get_u16(&pdu[5])};
}

Parsed parse_read_write(Bytes pdu) {
  if (pdu.size() < 10) return tl::unexpected(bad_value);
  const std::uint16_t reads = get_u16(&pdu[3]);
  const std::uint16_t writes = get_u16(&pdu[7]);
  if (reads == 0 || reads > max_read_registers || writes == 0 || writes > max_read_write_registers)
    return tl::unexpected(bad_value);
  if (pdu[9] != 2 * writes || pdu.size() != std::size_t{10} + pdu[9]) return tl::unexpected(bad_value);
  const auto read = Range::make(get_u16(&pdu[1]), reads);
  const auto write = Range::make(get_u16(&pdu[5]), writes);
  if (!read || !write) return tl::unexpected(bad_address);
  return ReadWriteRegisters{*read, {*write, pdu.from(10)}};
}

/// Sub-function 0 takes any data of whole words.
Parsed parse_diagnostics(Bytes pdu) {
  if (pdu.size() < 3) return tl::unexpected(bad_value);
  if (get_u16(&pdu[1]) != 0) return tl::unexpected(Exception::illegal_function);
  if (pdu.size() < 5 || pdu.size() % 2 == 0) return tl::unexpected(bad_value);
  return Echo{};
}

Parsed parse_schedule(Bytes pdu) {
  const auto parsed = parse_schedule_request(pdu);
  if (!parsed) return tl::unexpected(parsed.error());
  return std::visit([](const auto& what) -> Request { return what; }, *parsed);
}

}  // namespace

Parsed parse_request(Bytes pdu) {
  assert(!pdu.empty());
  const auto function = static_cast<Function>(pdu[0]);
  switch (function) {
    case Function::read_coils:
    case Function::read_discrete_inputs: return parse_read(function, pdu, max_read_bits);
    case Function::read_holding_registers:
    case Function::read_input_registers: return parse_read(function, pdu, max_read_registers);
    case Function::write_single_coil: return parse_write_coil(pdu);
    case Function::write_single_register: return parse_write_register(pdu);
    case Function::diagnostics: return parse_diagnostics(pdu);
    case Function::write_multiple_coils: return parse_write_coils(pdu);
    case Function::write_multiple_registers: return parse_write_registers(pdu);
    case Function::read_file_record: return parse_file_request(pdu);
    case Function::mask_write_register: return parse_mask_write(pdu);
    case Function::read_write_multiple_registers: return parse_read_write(pdu);
    case Function::encapsulated_interface: return parse_device_identification(pdu);
    case Function::wait_for_changes: return parse_changes_request(pdu);
    case Function::schedule_output: return parse_schedule(pdu);
  }
  return tl::unexpected(Exception::illegal_function);
}

std::size_t reply_exception(std::uint8_t function, Exception code, Span<std::uint8_t> pdu) {
  pdu[0] = static_cast<std::uint8_t>(function | exception_bit);
  pdu[1] = static_cast<std::uint8_t>(code);
  return 2;
}

std::size_t reply_bits(Function function, Span<const std::uint16_t> bits, Span<std::uint8_t> pdu) {
  assert(bits.size() <= max_read_bits);
  const std::size_t bytes = (bits.size() + 7) / 8;
  pdu[0] = static_cast<std::uint8_t>(function);
  pdu[1] = static_cast<std::uint8_t>(bytes);
  std::memset(&pdu[2], 0, bytes);
  for (std::size_t i = 0; i < bits.size(); ++i)
    if (bits[i] != 0) pdu[2 + i / 8] = static_cast<std::uint8_t>(pdu[2 + i / 8] | 1U << i % 8);
  return 2 + bytes;
}

std::size_t reply_registers(Function function, Span<const std::uint16_t> registers, Span<std::uint8_t> pdu) {
  assert(registers.size() <= max_read_registers);
  pdu[0] = static_cast<std::uint8_t>(function);
  pdu[1] = static_cast<std::uint8_t>(2 * registers.size());
  for (std::size_t i = 0; i < registers.size(); ++i) put_u16(&pdu[2 + 2 * i], registers[i]);
  return 2 + 2 * registers.size();
}

std::size_t reply_written(Bytes request, Span<std::uint8_t> pdu) {
  const auto function = static_cast<Function>(request[0]);
  const bool repeats_all =
      function != Function::write_multiple_coils && function != Function::write_multiple_registers;
  const std::size_t size = repeats_all ? request.size() : 5;
  std::memcpy(pdu.data(), request.data(), size);
  return size;
}

}  // namespace coupler::modbus
