// SPDX-License-Identifier: Apache-2.0
#include "coupler/modbus/client.hpp"

#include <algorithm>
#include <cassert>

namespace coupler::modbus {
namespace {

/// The `size` bytes of the values.
tl::expected<const std::uint8_t*, ReplyError> values_in(const ReadRequest& request, Bytes reply,
                                                        std::size_t size) {
  if (reply.size() != 2 + size || reply[0] != request.function() || reply[1] != size)
    return tl::unexpected(reply_error(request.function(), reply));
  return reply.data() + 2;
}

}  // namespace

ReadRequest::ReadRequest(Function function, Range range) {
  bytes_[0] = static_cast<std::uint8_t>(function);
  put_u16(&bytes_[1], range.start());
  put_u16(&bytes_[3], static_cast<std::uint16_t>(range.count()));
  assert(range.count() <= (function <= Function::read_discrete_inputs ? max_read_bits : max_read_registers));
}

tl::expected<void, ReplyError> take_bits(const ReadRequest& request, Bytes reply, std::uint8_t* bits) {
  const auto values = values_in(request, reply, (request.count() + 7U) / 8U);
  if (!values) return tl::unexpected(values.error());
  for (std::size_t i = 0; i < request.count(); ++i) bits[i] = (*values)[i / 8] >> i % 8 & 1;
  return {};
}

tl::expected<void, ReplyError> take_registers(const ReadRequest& request, Bytes reply,
                                              std::uint16_t* registers) {
  const auto values = values_in(request, reply, std::size_t{2} * request.count());
  if (!values) return tl::unexpected(values.error());
  for (std::size_t i = 0; i < request.count(); ++i) registers[i] = get_u16(*values + 2 * i);
  return {};
}

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

tl::expected<void, ReplyError> check_reply(const WriteRequest& request, Bytes reply) {
  const Bytes asked = request.pdu();
  const bool several = request.function() == Function::write_multiple_coils ||
                       request.function() == Function::write_multiple_registers;
  const std::size_t same = several ? 5 : 3;
  if (reply.size() != (several ? 5 : asked.size()) || !std::equal(&reply[0], &reply[0] + same, asked.begin()))
    return tl::unexpected(reply_error(asked[0], reply));
  const bool single = request.function() == Function::write_single_coil ||
                      request.function() == Function::write_single_register;
  if (single && get_u16(&reply[3]) != get_u16(&asked[3]))
    return tl::unexpected(ReplyError{std::nullopt, get_u16(&reply[3])});
  return {};
}

}  // namespace coupler::modbus
