// SPDX-License-Identifier: Apache-2.0
#include "coupler/modbus/identification_reply.hpp"

#include <algorithm>

#include "coupler/modbus/function.hpp"

namespace coupler::modbus {
namespace {

constexpr auto function = static_cast<std::uint8_t>(Function::encapsulated_interface);
constexpr std::size_t header_size = 7;

}  // namespace

std::array<std::uint8_t, 4> build_device_identification(ReadDeviceIdentification wanted) {
  return {function, mei_device_identification, static_cast<std::uint8_t>(wanted.access), wanted.object};
}

tl::expected<IdentificationReply, Refused> take_device_identification(Bytes reply,
                                                                      Span<IdentificationObject> objects) {
  if (reply.size() == 2 && reply[0] == (function | exception_bit))
    return tl::unexpected(Refused{static_cast<Exception>(reply[1])});
  if (reply.size() < header_size || reply[0] != function || reply[1] != mei_device_identification)
    return tl::unexpected(Refused{});
  IdentificationReply taken;
  taken.count = std::min<std::size_t>(reply[6], objects.size());
  taken.more = reply[4] != 0;
  taken.next = reply[5];
  Bytes rest = reply.from(header_size);
  for (std::size_t i = 0; i < taken.count; ++i) {
    if (rest.size() < 2 || rest.size() < 2U + rest[1]) return tl::unexpected(Refused{});
    const std::size_t size = rest[1];
    objects[i] = {rest[0], {reinterpret_cast<const char*>(rest.data()) + 2, size}};
    rest = rest.from(2 + size);
  }
  return taken;
}

}  // namespace coupler::modbus
