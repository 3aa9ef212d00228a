// SPDX-License-Identifier: Apache-2.0
// Read Device Identification (FC 43, MEI type 14, MAP 6.21), the client's side.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <tl/expected.hpp>

#include "coupler/base/span.hpp"
#include "coupler/modbus/bytes.hpp"
#include "coupler/modbus/device_identification.hpp"
#include "coupler/modbus/exception.hpp"

namespace coupler::modbus {

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

/// Puts the objects, views of `reply`, into `objects`, which has room for max_identification_objects.
tl::expected<IdentificationReply, Refused> take_device_identification(Bytes reply,
                                                                      Span<IdentificationObject> objects);

}  // namespace coupler::modbus
