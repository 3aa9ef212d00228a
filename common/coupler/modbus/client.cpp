// SPDX-License-Identifier: Apache-2.0
#include "coupler/modbus/client.hpp"

#include <algorithm>
#include <cassert>

namespace coupler::modbus {
namespace {

bool is_single_write(Function function) {
  return function == Function::write_single_coil || function == Function::write_single_register;
}

/// `reply` has so many bytes, and begins with `same` bytes of the request.
bool repeats(Bytes request, Bytes reply, std::size_t size, std::size_t same) {
  return reply.size() == size && std::equal(reply.begin(), reply.begin() + same, request.begin());
}

bool holds(Bytes reply, std::size_t bytes) { return reply.size() == 2 + bytes && reply[1] == bytes; }

/// `reply` has the function code of the request.
bool fits(Bytes request, Bytes reply) {
  switch (static_cast<Function>(request[0])) {
    case Function::read_coils:
    case Function::read_discrete_inputs: return holds(reply, (get_u16(&request[3]) + 7U) / 8U);
    case Function::read_holding_registers:
    case Function::read_input_registers: return holds(reply, std::size_t{2} * get_u16(&request[3]));
    case Function::write_single_coil:
    case Function::write_single_register:
    case Function::mask_write_register: return repeats(request, reply, request.size(), 3);
    case Function::write_multiple_coils:
    case Function::write_multiple_registers: return repeats(request, reply, 5, 5);
    default: return true;
  }
}

}  // namespace

ReadRequest::ReadRequest(Function function, Range range) {
  bytes_[0] = static_cast<std::uint8_t>(function);
  put_u16(&bytes_[1], range.start());
  put_u16(&bytes_[3], static_cast<std::uint16_t>(range.count()));
  assert(range.count() <= (reads_bits() ? max_read_bits : max_read_registers));
}

tl::expected<void, ReplyError> take_values(const ReadRequest& request, Bytes reply, std::uint16_t* values) {
  if (auto answers = check_reply(request.pdu(), reply); !answers) return answers;
  const Bytes from = reply.from(2);
  if (request.reads_bits())
    for (std::size_t i = 0; i < request.count(); ++i) values[i] = from[i / 8] >> i % 8 & 1;
  else
    for (std::size_t i = 0; i < request.count(); ++i) values[i] = get_u16(&from[2 * i]);
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

tl::expected<void, ReplyError> check_reply(Bytes request, Bytes reply) {
  if (reply.empty() || reply[0] != request[0] || !fits(request, reply))
    return tl::unexpected(reply_error(request[0], reply));
  if (is_single_write(static_cast<Function>(request[0])) && get_u16(&reply[3]) != get_u16(&request[3]))
    return tl::unexpected(ReplyError{std::nullopt, get_u16(&reply[3])});
  return {};
}

}  // namespace coupler::modbus
