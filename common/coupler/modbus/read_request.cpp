// SPDX-License-Identifier: Apache-2.0
#include "coupler/modbus/read_request.hpp"

#include <cassert>

#include "coupler/modbus/limits.hpp"

namespace coupler::modbus {
namespace {

/// The `size` bytes of the values. A reply with more or fewer is none.
tl::expected<const std::uint8_t*, Refused> values_in(const ReadRequest& request, Bytes reply,
                                                     std::size_t size) {
  if (reply.size() == 2 && reply[0] == (request.function() | exception_bit))
    return tl::unexpected(Refused{static_cast<Exception>(reply[1])});
  if (reply.size() != 2 + size || reply[0] != request.function() || reply[1] != size)
    return tl::unexpected(Refused{});
  return reply.data() + 2;
}

}  // namespace

ReadRequest::ReadRequest(Function function, Range range) {
  bytes_[0] = static_cast<std::uint8_t>(function);
  put_u16(&bytes_[1], range.start());
  put_u16(&bytes_[3], static_cast<std::uint16_t>(range.count()));
  assert(range.count() <= (function <= Function::read_discrete_inputs ? max_read_bits : max_read_registers));
}

tl::expected<void, Refused> take_bits(const ReadRequest& request, Bytes reply, std::uint8_t* bits) {
  const auto values = values_in(request, reply, (request.count() + 7U) / 8U);
  if (!values) return tl::unexpected(values.error());
  for (std::size_t i = 0; i < request.count(); ++i) bits[i] = (*values)[i / 8] >> i % 8 & 1;
  return {};
}

tl::expected<void, Refused> take_registers(const ReadRequest& request, Bytes reply,
                                           std::uint16_t* registers) {
  const auto values = values_in(request, reply, std::size_t{2} * request.count());
  if (!values) return tl::unexpected(values.error());
  for (std::size_t i = 0; i < request.count(); ++i) registers[i] = get_u16(*values + 2 * i);
  return {};
}

}  // namespace coupler::modbus
