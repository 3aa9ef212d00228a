// SPDX-License-Identifier: Apache-2.0
#include "coupler/modbus/device_identification.hpp"

#include <algorithm>
#include <cstring>

#include "coupler/modbus/limits.hpp"
#include "coupler/modbus/pdu.hpp"

namespace coupler::modbus {
namespace {

using Access = ReadDeviceIdentification::Access;
using Objects = Span<const IdentificationObject>;

constexpr auto function = static_cast<std::uint8_t>(Function::encapsulated_interface);
constexpr std::size_t header_size = 7;
constexpr std::uint8_t last_basic = 2;
constexpr std::uint8_t last_regular = 0x7F;
// Conformity levels: by stream and individually.
constexpr std::uint8_t is_regular = 0x82;
constexpr std::uint8_t is_extended = 0x83;

std::size_t size_of(const IdentificationObject& object) {
  return std::min(object.value.size(), max_identification_size);
}

Objects up_to(std::uint8_t last, Objects objects) {
  return objects.first(static_cast<std::size_t>(
      std::count_if(objects.begin(), objects.end(), [last](const auto& o) { return o.id <= last; })));
}

/// Those of the category, from the wanted one on.
Objects selected(ReadDeviceIdentification wanted, Objects objects) {
  if (wanted.access == Access::basic) objects = up_to(last_basic, objects);
  if (wanted.access == Access::regular) objects = up_to(last_regular, objects);
  for (std::size_t i = 0; i < objects.size(); ++i)
    if (objects[i].id == wanted.object) return objects.from(i);
  return wanted.access == Access::individual ? Objects() : objects;
}

std::uint8_t* put(const IdentificationObject& object, std::uint8_t* at) {
  const std::size_t size = size_of(object);
  at[0] = object.id;
  at[1] = static_cast<std::uint8_t>(size);
  std::memcpy(at + 2, object.value.data(), size);
  return at + 2 + size;
}

}  // namespace

tl::expected<ReadDeviceIdentification, Exception> parse_device_identification(Bytes pdu) {
  if (pdu.size() < 2) return tl::unexpected(Exception::illegal_data_value);
  if (pdu[1] != mei_device_identification) return tl::unexpected(Exception::illegal_function);
  if (pdu.size() != 4 || pdu[2] < 1 || pdu[2] > 4) return tl::unexpected(Exception::illegal_data_value);
  return ReadDeviceIdentification{static_cast<Access>(pdu[2]), pdu[3]};
}

tl::expected<std::size_t, Exception> reply_device_identification(ReadDeviceIdentification wanted,
                                                                 Objects objects, Span<std::uint8_t> pdu) {
  Objects rest = selected(wanted, objects);
  if (rest.empty()) return tl::unexpected(Exception::illegal_data_address);
  if (wanted.access == Access::individual) rest = rest.first(1);

  std::uint8_t* at = &pdu[header_size];
  std::uint8_t count = 0;
  while (!rest.empty() &&
         static_cast<std::size_t>(at - pdu.data()) + 2 + size_of(rest.front()) <= max_pdu_size) {
    at = put(rest.front(), at);
    rest = rest.from(1);
    ++count;
  }
  pdu[0] = function;
  pdu[1] = mei_device_identification;
  pdu[2] = static_cast<std::uint8_t>(wanted.access);
  pdu[3] = objects.back().id > last_regular ? is_extended : is_regular;
  pdu[4] = rest.empty() ? 0x00 : 0xFF;
  pdu[5] = rest.empty() ? 0x00 : rest.front().id;
  pdu[6] = count;
  return static_cast<std::size_t>(at - pdu.data());
}

std::array<std::uint8_t, 4> build_device_identification(ReadDeviceIdentification wanted) {
  return {function, mei_device_identification, static_cast<std::uint8_t>(wanted.access), wanted.object};
}

std::size_t identification_reply_size(Bytes beginning) {
  if (beginning.size() < header_size) return 0;
  std::size_t size = header_size;
  for (unsigned object = 0; object < beginning[6]; ++object) {
    if (beginning.size() < size + 2) return 0;
    size += std::size_t{2} + beginning[size + 1];
  }
  return size;
}

tl::expected<IdentificationReply, ReplyError> take_device_identification(Bytes reply,
                                                                         Span<IdentificationObject> objects) {
  if (reply.size() < header_size || reply[0] != function || reply[1] != mei_device_identification)
    return tl::unexpected(reply_error(function, reply));
  IdentificationReply taken;
  taken.count = std::min<std::size_t>(reply[6], objects.size());
  taken.more = reply[4] != 0;
  taken.next = reply[5];
  Bytes rest = reply.from(header_size);
  for (std::size_t i = 0; i < taken.count; ++i) {
    if (rest.size() < 2 || rest.size() < 2U + rest[1]) return tl::unexpected(ReplyError{});
    const std::size_t size = rest[1];
    objects[i] = {rest[0], {reinterpret_cast<const char*>(rest.data()) + 2, size}};
    rest = rest.from(2 + size);
  }
  return taken;
}

}  // namespace coupler::modbus
