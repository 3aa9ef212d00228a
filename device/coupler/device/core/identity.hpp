// SPDX-License-Identifier: Apache-2.0
// What a node reports of itself: its identity area, device identification, and its map.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <tl/expected.hpp>

#include "coupler/device/core/image.hpp"
#include "coupler/device/core/statistics.hpp"
#include "coupler/device/core/watchdog.hpp"
#include "coupler/map/identity.hpp"
#include "coupler/modbus/device_identification.hpp"
#include "coupler/modbus/server.hpp"

namespace coupler::device {

/// Writes the constant part of the identity area (coupler/map/identity.hpp) into the image.
void write_identity(const Map& map, const identity::Machine& machine, const identity::Functions& functions,
                    Image& image);

/// The same for counters and watchdog, which are updated when a client reads there.
void write_statistics(const Statistics& statistics, TimePoint now, Image& image);
void write_watchdog(const OutputWatchdog& watchdog, TimePoint now, Image& image);

/// Answers FC 43/14. Objects: 0 "OpenCoupler", 1 and 4 the map's name, 2 the project's version,
/// 5 the fingerprint in hexadecimal; if they are known, 6 the machine's hostname and 80 its serial, in
/// hexadecimal as well.
tl::expected<std::size_t, modbus::Exception> identify(const Map& map, const identity::Machine& machine,
                                                      modbus::ReadDeviceIdentification wanted,
                                                      Span<std::uint8_t> pdu);

/// A piece of the map's text as FC 20 serves it (coupler/map/identity.hpp says how): fills `bytes`, two for
/// each register asked for. False if the text ends before.
bool read_map_file(std::string_view text, modbus::FileRecord wanted, Span<std::uint8_t> bytes);

}  // namespace coupler::device
