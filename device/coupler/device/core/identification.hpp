// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "coupler/map/identity.hpp"
#include "coupler/map/map.hpp"
#include "coupler/modbus/device_identification.hpp"

namespace coupler::device {

/// What FC 43/14 tells of a node. Objects: 0 "OpenCoupler", 1 and 4 the map's name, 2 the project's version,
/// 5 the fingerprint in hexadecimal; if they are known, 6 the machine's hostname and 80 its serial, in
/// hexadecimal as well.
tl::expected<std::size_t, modbus::Exception> identify(const Map& map, const identity::Machine& machine,
                                                      modbus::ReadDeviceIdentification wanted,
                                                      Span<std::uint8_t> pdu);

}  // namespace coupler::device
