// SPDX-License-Identifier: Apache-2.0
// Read Device Identification (FC 43, MEI type 14, MAP 6.21), both directions.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include <tl/expected.hpp>

#include "coupler/base/span.hpp"
#include "coupler/modbus/pdu.hpp"

namespace coupler::modbus {

constexpr std::uint8_t mei_device_identification = 14;

struct ReadDeviceIdentification {
  enum class Access : std::uint8_t { basic = 1, regular = 2, extended = 3, individual = 4 };
  Access access;
  std::uint8_t object;  ///< the first one wanted; with `individual` the only one
};

/// Errors: 01 another MEI type; 03 a wrong size, an access code outside 1 … 4.
tl::expected<ReadDeviceIdentification, Exception> parse_device_identification(Bytes pdu);

struct IdentificationObject {
  std::uint8_t id;
  std::string_view value;  ///< ASCII; what a reply has no room for (above max_identification_size) is cut off
};

/// The object's number, its size and itself in a PDU of their own.
constexpr std::size_t max_identification_size = 244;

/// The reply of a device whose identification is basic and regular (conformity level 0x82), and extended
/// (0x83) if it has an object from 0x80 on. `objects`, sorted by id, holds 0, 1 and 2 at least. The extended
/// stream of a device that has none is the regular one. A stream that does not fit goes on in further
/// requests; one that begins at an object that is not there begins at the first. `pdu` holds at least
/// max_pdu_size bytes. Error: 02 no such individual object.
tl::expected<std::size_t, Exception> reply_device_identification(ReadDeviceIdentification wanted,
                                                                 Span<const IdentificationObject> objects,
                                                                 Span<std::uint8_t> pdu);

/// The PDU that asks for it.
std::array<std::uint8_t, 4> build_device_identification(ReadDeviceIdentification wanted);

/// No reply holds more: each has two bytes at least.
constexpr std::size_t max_identification_objects = 123;

/// One reply of a stream.
struct IdentificationReply {
  std::size_t count = 0;  ///< objects that it holds
  bool more = false;      ///< others follow, to be asked for from `next` on
  std::uint8_t next = 0;
};

/// How many bytes a reply has, as far as its beginning says; 0: that is too little to know.
std::size_t identification_reply_size(Bytes beginning);

/// Puts the objects, views of `reply`, into `objects`, which has room for max_identification_objects.
tl::expected<IdentificationReply, ReplyError> take_device_identification(Bytes reply,
                                                                         Span<IdentificationObject> objects);

}  // namespace coupler::modbus
