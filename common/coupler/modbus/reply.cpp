// SPDX-License-Identifier: Apache-2.0
#include "coupler/modbus/reply.hpp"

#include <cassert>
#include <cstring>

#include "coupler/modbus/limits.hpp"

namespace coupler::modbus {

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
