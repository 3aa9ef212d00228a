// SPDX-License-Identifier: Apache-2.0
#include "coupler/modbus/write_request.hpp"

#include <algorithm>
#include <cassert>

namespace coupler::modbus {

WriteRequest::WriteRequest(Function function, std::uint16_t address, std::uint16_t value) {
  bytes_[0] = static_cast<std::uint8_t>(function);
  put_u16(&bytes_[1], address);
  put_u16(&bytes_[3], value);
}

WriteRequest WriteRequest::coil(std::uint16_t address, bool on) {
  return {Function::write_single_coil, address, static_cast<std::uint16_t>(on ? 0xFF00 : 0x0000)};
}

WriteRequest WriteRequest::register_value(std::uint16_t address, std::uint16_t value) {
  return {Function::write_single_register, address, value};
}

WriteRequest WriteRequest::coils(std::uint16_t address, Span<const std::uint16_t> bits) {
  assert(!bits.empty() && bits.size() <= max_write_bits);
  WriteRequest request(Function::write_multiple_coils, address, static_cast<std::uint16_t>(bits.size()));
  const std::size_t bytes = (bits.size() + 7) / 8;
  request.bytes_[5] = static_cast<std::uint8_t>(bytes);
  request.size_ = 6 + bytes;
  for (std::size_t i = 0; i < bits.size(); ++i)
    if (bits[i] != 0)
      request.bytes_[6 + i / 8] = static_cast<std::uint8_t>(request.bytes_[6 + i / 8] | 1U << i % 8);
  return request;
}

WriteRequest WriteRequest::registers(std::uint16_t address, Span<const std::uint16_t> values) {
  assert(!values.empty() && values.size() <= max_write_registers);
  WriteRequest request(Function::write_multiple_registers, address,
                       static_cast<std::uint16_t>(values.size()));
  request.bytes_[5] = static_cast<std::uint8_t>(2 * values.size());
  request.size_ = 6 + 2 * values.size();
  for (std::size_t i = 0; i < values.size(); ++i) put_u16(&request.bytes_[6 + 2 * i], values[i]);
  return request;
}

WriteRequest WriteRequest::mask(std::uint16_t address, std::uint16_t and_mask, std::uint16_t or_mask) {
  WriteRequest request(Function::mask_write_register, address, and_mask);
  put_u16(&request.bytes_[5], or_mask);
  request.size_ = 7;
  return request;
}

tl::expected<void, Refused> check_reply(const WriteRequest& request, Bytes reply) {
  const Bytes asked = request.pdu();
  if (reply.size() == 2 && reply[0] == (asked[0] | exception_bit))
    return tl::unexpected(Refused{static_cast<Exception>(reply[1])});
  const bool several = request.function() == Function::write_multiple_coils ||
                       request.function() == Function::write_multiple_registers;
  const std::size_t same = several ? 5 : 3;
  if (reply.size() != (several ? 5 : asked.size()) || !std::equal(&reply[0], &reply[0] + same, asked.begin()))
    return tl::unexpected(Refused{});
  return {};
}

}  // namespace coupler::modbus
